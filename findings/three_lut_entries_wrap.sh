#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# three.js 0.187.0 (LUTCubeLoader), on Node.js.
#
# By default the loader keeps the entries of a .cube LUT as bytes, and what is not in [0, 1] wraps: 1.01 becomes 1/255,
# 1.5 becomes 126/255, and -0.01 becomes 254/255, without a warning. Such entries are valid and common (LUTs that make
# linear light, or keep highlights and colours out of gamut); they turn highlights black and shadows white. With
# setType(FloatType) entries are kept as they are. What the loader reads as domainMin and domainMax, LUTPass and the node
# lut3D do not use: inputs are looked up as if the domain were [0, 1].
#
# Needs npm. Exits with 1 if the results differ from these.
set -euo pipefail
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cd "$folder"
npm install --silent --ignore-scripts --no-audit --no-fund three@0.187.0

cat >read.mjs <<'JS'
import { LUTCubeLoader } from 'three/examples/jsm/loaders/LUTCubeLoader.js';
import { FloatType } from 'three';

// Eight entries, all grey, of which two matter.
const grey = (value, times) => `${value} ${value} ${value}\n`.repeat(times);
const lut = (value) => `LUT_3D_SIZE 2\n${grey(0, 3)}${grey(value, 2)}${grey(1, 3)}`;
for (const value of [0.5, 1, 1.01, 1.5, -0.01]) {
  const entry = (loader) => loader.parse(lut(value)).texture3D.image.data[4 * 3];
  console.log(`${value}: by default ${entry(new LUTCubeLoader())} of 255,`
    + ` as a float ${entry(new LUTCubeLoader().setType(FloatType)).toFixed(2)}`);
}
JS
node read.mjs | tee seen
for user in postprocessing/LUTPass.js tsl/display/Lut3DNode.js; do
    echo "$user uses the domain: $(grep -cim1 domain "node_modules/three/examples/jsm/$user" || true)"
done | tee -a seen

diff - seen <<'END'
0.5: by default 127 of 255, as a float 0.50
1: by default 255 of 255, as a float 1.00
1.01: by default 1 of 255, as a float 1.01
1.5: by default 126 of 255, as a float 1.50
-0.01: by default 254 of 255, as a float -0.01
postprocessing/LUTPass.js uses the domain: 0
tsl/display/Lut3DNode.js uses the domain: 0
END
