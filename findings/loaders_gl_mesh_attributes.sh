#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# loaders.gl 4.5.4 (@loaders.gl/core 4.5.4, obj 4.5.2, ply 4.4.5), on Node.js; three.js 0.187.0 beside it.
#
# Two readers of meshes in loaders.gl return wrong attributes of valid files, without a warning:
# - OBJ: if some faces have UVs or normals and others have none, as OBJ allows, those that there are go to the first faces of
#   the object, whichever they belong to. The rest gets 0. So a textured part takes the place of an untextured one.
# - PLY: float colours (1, 0.5, 0.25) become the bytes 1, 0, 0, of 255: black. Bytes are read as they are, and colours of 16
#   bits are cut to their lower 8.
# three.js reads these OBJ files as meant.
#
# Needs npm. Exits with 1 if the results differ from these.
set -euo pipefail
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cd "$folder"
npm install --silent --ignore-scripts --no-audit --no-fund --legacy-peer-deps @loaders.gl/core@4.5.4 \
    @loaders.gl/obj@4.5.2 @loaders.gl/ply@4.4.5 three@0.187.0

cat >read.mjs <<'JS'
import { parse } from '@loaders.gl/core';
import { OBJLoader } from '@loaders.gl/obj';
import { PLYLoader } from '@loaders.gl/ply';
import { OBJLoader as ThreeOBJ } from 'three/examples/jsm/loaders/OBJLoader.js';
import { PLYLoader as ThreePLY } from 'three/examples/jsm/loaders/PLYLoader.js';

const list = (values) => Array.from(values, (v) => +v.toFixed(2)).join(' ');

const vertices = 'v 0 0 0\nv 1 0 0\nv 0 1 0\nv 1 1 0\nvt 0.1 0.2\nvt 0.3 0.4\nvt 0.5 0.6\nvn 1 0 0\n';
for (const [name, faces] of Object.entries({
  'UVs at the second of two triangles': 'f 2 4 3\nf 1/1 2/2 3/3\n',
  'UVs at the first': 'f 1/1 2/2 3/3\nf 2 4 3\n',
  'a normal at the second': 'f 2 4 3\nf 1//1 2//1 3//1\n',
})) {
  const { attributes } = await parse(vertices + faces, OBJLoader);
  const { uv, normal } = new ThreeOBJ().parse(vertices + faces).children[0].geometry.attributes;
  const mine = attributes.TEXCOORD_0 ?? attributes.NORMAL, theirs = attributes.TEXCOORD_0 ? uv : normal;
  console.log(`OBJ, ${name}:`);
  console.log(`  loaders.gl ${list(mine.value)}`);
  console.log(`  three.js   ${list(theirs.array)}`);
}

for (const [type, colour] of Object.entries({ uchar: '255 128 64', float: '1 0.5 0.25', ushort: '65535 32768 16400' })) {
  const ply = 'ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\n'
    + ['red', 'green', 'blue'].map((c) => `property ${type} ${c}\n`).join('')
    + 'element face 1\nproperty list uchar int vertex_indices\nend_header\n'
    + `0 0 0 ${colour}\n1 0 0 ${colour}\n0 1 0 ${colour}\n3 0 1 2\n`;
  const { COLOR_0 } = (await parse(new TextEncoder().encode(ply).buffer, PLYLoader)).attributes;
  console.log(`PLY, ${type} ${colour}: loaders.gl ${list(COLOR_0.value.slice(0, 3))}`
    + `${COLOR_0.normalized && COLOR_0.value instanceof Uint8Array ? ' of 255' : ''}`);
}
JS
node read.mjs | tee seen

diff - seen <<'END'
OBJ, UVs at the second of two triangles:
  loaders.gl 0.1 0.2 0.3 0.4 0.5 0.6 0 0 0 0 0 0
  three.js   0 0 0 0 0 0 0.1 0.2 0.3 0.4 0.5 0.6
OBJ, UVs at the first:
  loaders.gl 0.1 0.2 0.3 0.4 0.5 0.6 0 0 0 0 0 0
  three.js   0.1 0.2 0.3 0.4 0.5 0.6 0 0 0 0 0 0
OBJ, a normal at the second:
  loaders.gl 1 0 0 1 0 0 1 0 0 0 0 0 0 0 0 0 0 0
  three.js   0 0 1 0 0 1 0 0 1 1 0 0 1 0 0 1 0 0
PLY, uchar 255 128 64: loaders.gl 255 128 64 of 255
PLY, float 1 0.5 0.25: loaders.gl 1 0 0 of 255
PLY, ushort 65535 32768 16400: loaders.gl 255 0 16 of 255
END
