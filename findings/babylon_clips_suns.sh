#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# Babylon.js 9.35.0 (what HDRCubeTexture does by default to light diffuse surfaces), on Node.js.
#
# To light diffuse surfaces, Babylon sums an environment up as spherical harmonics, after it clipped each channel of each
# texel at 4096. HDRIs of clear skies have suns above that, 65,536 and more, most of whose light is lost without a warning:
# of the sky here, with a warm sun, 1.13 of 3.25 is left of red, and the sun has turned white. The cube map for reflections
# is not clipped, so that metal and plaster disagree. Up to 4096 the sums are right. The limit is MAX_HDRI_VALUE, a static
# that is marked as internal.
#
# Needs npm. Exits with 1 if the light is another than written here.
set -euo pipefail
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cd "$folder"
npm install --silent --ignore-scripts --no-audit --no-fund @babylonjs/core@9.35.0

cat >light.mjs <<'JS'
import { GetCubeMapTextureData } from '@babylonjs/core/Misc/HighDynamicRange/hdr.js';
import { CubeMapToSphericalPolynomialTools } from '@babylonjs/core/Misc/HighDynamicRange/cubemapToSphericalPolynomial.js';

const W = 1024, H = 512;

// A sky of 1 with a sun of 4 x 4 texels, as a Radiance file without compression.
function sky(sun) {
  const header = Buffer.from(`#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y ${H} +X ${W}\n`);
  const texels = Buffer.alloc(4 * W * H), exponent = Math.floor(Math.log2(Math.max(...sun))) + 1;
  const sun_texel = [...sun.map((v) => v * 2 ** (8 - exponent)), 128 + exponent];
  for (let i = 0; i < W * H; i++) {
    const x = i % W, y = Math.floor(i / W);
    texels.set(x >= 512 && x < 516 && y >= 128 && y < 132 ? sun_texel : [128, 128, 128, 129], 4 * i);
  }
  return new Uint8Array(Buffer.concat([header, texels])).buffer;
}

// The mean over all directions: 16 texels of the sun, weighted by their solid angle.
const share = 4 / W * (Math.cos(Math.PI * 128 / H) - Math.cos(Math.PI * 132 / H)) / 2;

for (const sun of [[1, 1, 1], [1024, 768, 512], [4096, 3072, 2048], [16384, 12288, 8192], [65536, 49152, 32768]]) {
  const cube = GetCubeMapTextureData(sky(sun), 256);
  const { xx, yy, zz } = CubeMapToSphericalPolynomialTools.ConvertCubeMapToSphericalPolynomial(cube);
  const numbers = (values) => values.map((v) => v.toFixed(2)).join(' ');
  // Irradiance / pi, averaged over all normals, is the mean radiance.
  console.log(`sun ${sun.join(' ')}: in the picture ${numbers(sun.map((v) => 1 + (v - 1) * share))},`
    + ` in Babylon ${numbers(['x', 'y', 'z'].map((c) => (xx[c] + yy[c] + zz[c]) / 3))}`);
}
JS
node light.mjs | tee seen

diff - seen <<'END'
sun 1 1 1: in the picture 1.00 1.00 1.00, in Babylon 1.00 1.00 1.00
sun 1024 768 512: in the picture 1.04 1.03 1.02, in Babylon 1.03 1.02 1.02
sun 4096 3072 2048: in the picture 1.14 1.11 1.07, in Babylon 1.13 1.10 1.07
sun 16384 12288 8192: in the picture 1.56 1.42 1.28, in Babylon 1.13 1.13 1.13
sun 65536 49152 32768: in the picture 3.25 2.69 2.12, in Babylon 1.13 1.13 1.13
END
