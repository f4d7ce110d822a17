#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# three.js 0.187.0 (EXRLoader) and Babylon.js 9.35.0 (their EXR loader), on Node.js.
#
# OpenEXR stores the type of each channel on its own: half R and G beside a float B is a valid, common file (beauty in
# half, data in float). Both loaders read all channels as the type of one, without an error: of two equal pixels
# (1, 2, 3) they return a blue of 0 and of 2.125. A file whose channels are all float is read as it is.
#
# Needs npm. Exits with 1 if the loaders read the file in another way than written here.
set -euo pipefail
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cd "$folder"
npm install --silent --ignore-scripts --no-audit --no-fund three@0.187.0 @babylonjs/core@9.35.0

cat >read.mjs <<'END'
import { EXRLoader } from 'three/examples/jsm/loaders/EXRLoader.js';
import { FloatType } from 'three';
import { GetExrHeader } from '@babylonjs/core/Materials/Textures/Loaders/EXR/exrLoader.header.js';
import { CreateDecoderAsync, ScanData } from '@babylonjs/core/Materials/Textures/Loaders/EXR/exrLoader.decoder.js';
import { EXROutputType } from '@babylonjs/core/Materials/Textures/Loaders/EXR/exrLoader.configuration.js';

const HALF = 1, FLOAT = 2;

// Two pixels of R = 1, G = 2, B = 3, uncompressed. `types` are those of B, G, R: EXR sorts channels by name.
function exr(types) {
  const bytes = [];
  const u8 = (...values) => bytes.push(...values);
  const u16 = (v) => u8(v & 255, v >> 8);
  const i32 = (v) => u8(v & 255, (v >> 8) & 255, (v >> 16) & 255, (v >> 24) & 255);
  const f32 = (v) => u8(...Buffer.from(new Float32Array([v]).buffer));
  const text = (s) => u8(...Buffer.from(s), 0);
  const attribute = (name, type, size) => { text(name); text(type); i32(size); };
  u8(0x76, 0x2f, 0x31, 0x01);
  i32(2);
  attribute('channels', 'chlist', 3 * 18 + 1);
  ['B', 'G', 'R'].forEach((name, c) => { text(name); i32(types[c]); i32(0); i32(1); i32(1); });
  u8(0);
  attribute('compression', 'compression', 1); u8(0);
  for (const window of ['dataWindow', 'displayWindow']) { attribute(window, 'box2i', 16); [0, 0, 1, 0].forEach(i32); }
  attribute('lineOrder', 'lineOrder', 1); u8(0);
  attribute('pixelAspectRatio', 'float', 4); f32(1);
  attribute('screenWindowCenter', 'v2f', 8); f32(0); f32(0);
  attribute('screenWindowWidth', 'float', 4); f32(1);
  u8(0);
  i32(bytes.length + 8); i32(0); // the table of offsets: one line
  i32(0); i32(types.reduce((size, type) => size + 2 * (type === HALF ? 2 : 4), 0));
  const half = { 1: 0x3c00, 2: 0x4000, 3: 0x4200 };
  [3, 2, 1].forEach((v, c) => { for (let x = 0; x < 2; x++) types[c] === HALF ? u16(half[v]) : f32(v); });
  return new Uint8Array(bytes).buffer;
}

const loaders = {
  three: async (file) => new EXRLoader().setDataType(FloatType).parse(file).data,
  babylon: async (file) => {
    const view = new DataView(file), offset = { value: 0 }, header = GetExrHeader(view, offset);
    const decoder = await CreateDecoderAsync(header, view, offset, EXROutputType.Float);
    ScanData(decoder, header, view, offset);
    return decoder.byteArray;
  },
};
for (const [name, types] of Object.entries({ float: [FLOAT, FLOAT, FLOAT], mixed: [FLOAT, HALF, HALF] }))
  for (const [loader, load] of Object.entries(loaders))
    console.log(`${loader} ${name}: ${Array.from(await load(exr(types)))}`);
END
node read.mjs | tee seen

diff - seen <<'END'
three float: 1,2,3,1,1,2,3,1
babylon float: 1,2,3,1,1,2,3,1
three mixed: 1,2,0,1,1,2,2.125,1
babylon mixed: 1,2,0,1,1,2,2.125,1
END
