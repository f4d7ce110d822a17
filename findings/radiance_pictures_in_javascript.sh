#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# three.js 0.187.0 (HDRLoader, earlier RGBELoader), Babylon.js 9.35.0 and hdrify 1.2.1, on Node.js.
#
# Three things that these readers of Radiance pictures (.hdr) do without an error:
# - One pixel, bytes 128 128 128 129, is 1 in Babylon (the mantissa over 256, as in OpenImageIO), 1.004 in three.js
#   (over 255), and 1.008 in hdrify. All of an HDRI's light is .4 % brighter in three.js than in a bake of the same file.
# - The format's older run-length encoding (a pixel 1 1 1 n repeats the one before n times), which is valid, is taken for
#   pixels by three.js and Babylon: the picture is scrambled, and three.js returns fewer pixels than it says.
# - three.js takes a picture in XYZ (FORMAT=32-bit_rle_xyze) for RGB. The other two refuse it, as hdrify does old runs.
#
# Needs npm. Exits with 1 if the results differ from these.
set -euo pipefail
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cd "$folder"
npm install --silent --ignore-scripts --no-audit --no-fund three@0.187.0 @babylonjs/core@9.35.0 hdrify@1.2.1

cat >read.mjs <<'JS'
import { HDRLoader } from 'three/examples/jsm/loaders/HDRLoader.js';
import { FloatType } from 'three';
import { RGBE_ReadHeader, RGBE_ReadPixels } from '@babylonjs/core/Misc/HighDynamicRange/hdr.js';
import { readHdr } from 'hdrify';

// 16 x 16 pixels: the upper half red, the lower half blue.
const W = 16, H = 16, RED = [128, 0, 0, 129], BLUE = [0, 0, 128, 129], WHITE = [128, 128, 128, 129];
const header = (format) => Buffer.from(`#?RADIANCE\nFORMAT=${format}\n\n-Y ${H} +X ${W}\n`);
const file = (format, bytes) => new Uint8Array([...header(format), ...bytes]);
const rows = (row) => Array.from({ length: H }, (_, y) => row(y < H / 2 ? RED : BLUE)).flat();
const files = {
  white: file('32-bit_rle_rgbe', Array(W * H).fill(WHITE).flat()),
  'old runs': file('32-bit_rle_rgbe', rows((pixel) => [...pixel, 1, 1, 1, W - 1])),
  XYZ: file('32-bit_rle_xyze', rows((pixel) => Array(W).fill(pixel).flat())),
};
const readers = {
  three: (bytes) => [new HDRLoader().setDataType(FloatType).parse(bytes.buffer).data, 4],
  babylon: (bytes) => [RGBE_ReadPixels(bytes, RGBE_ReadHeader(bytes)), 3],
  hdrify: (bytes) => [readHdr(bytes).data, 4],
};
for (const [name, bytes] of Object.entries(files))
  for (const [reader, read] of Object.entries(readers)) {
    try {
      const [data, channels] = read(bytes);
      const pixel = (i) => Array.from(data.slice(i * channels, i * channels + 3), (v) => v.toFixed(3)).join(' ');
      console.log(`${name}, ${reader}: ${data.length / channels} pixels, at the top ${pixel(0)}, next ${pixel(1)}, ` +
        `last ${pixel(data.length / channels - 1)}`);
    } catch {
      console.log(`${name}, ${reader}: an error`);
    }
  }
JS
node read.mjs | tee seen

diff - seen <<'END'
white, three: 256 pixels, at the top 1.004 1.004 1.004, next 1.004 1.004 1.004, last 1.004 1.004 1.004
white, babylon: 256 pixels, at the top 1.000 1.000 1.000, next 1.000 1.000 1.000, last 1.000 1.000 1.000
white, hdrify: 256 pixels, at the top 1.008 1.008 1.008, next 1.008 1.008 1.008, last 1.008 1.008 1.008
old runs, three: 32 pixels, at the top 1.004 0.000 0.000, next 0.000 0.000 0.000, last 0.000 0.000 0.000
old runs, babylon: 256 pixels, at the top 1.000 0.000 0.000, next 0.000 0.000 0.000, last 0.000 0.000 0.000
old runs, hdrify: an error
XYZ, three: 256 pixels, at the top 1.004 0.000 0.000, next 1.004 0.000 0.000, last 0.000 0.000 1.004
XYZ, babylon: an error
XYZ, hdrify: an error
END
