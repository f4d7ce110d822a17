#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# three.js 0.187.0 (its exporters) and glTF-Transform 4.5.1 on Node.js, and assimp 5.2.5 (Debian 12's assimp-utils and
# libassimp5 5.2.5~ds0-1+b1).
#
# A node with a negative scale mirrors its mesh, which turns the order of each triangle's vertices around. glTF has renderers
# take the other side for the front, as three.js does. Whoever bakes the transform into the vertices must swap two of each
# triangle instead. The exporters of STL, PLY and OBJ of three.js and assimp, and three's applyMatrix4, do not: mirrored
# objects (the other half of a car, a left glove) come out inside out, beside others that are right, without a warning.
# three's STL also has inward normals. In the other files normals and triangles contradict each other, so that it depends on
# the reader whether the object is black or culled, or occlusion is baked on its inside. glTF-Transform swaps.
#
# Needs npm, and apt-get with the archive of Debian 12 on amd64; installs nothing: unpacks the packages in a temporary
# folder. Exits with 1 if the results differ from these.
set -euo pipefail
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cd "$folder"
mkdir -p archives/partial root
touch status # as if nothing were installed, so that all that the programs need is downloaded
apt-get -qq -y --no-install-recommends --download-only -o Debug::NoLocking=1 -o APT::Sandbox::User=root \
    -o Dir::State::status="$folder/status" -o Dir::Cache::archives="$folder/archives" \
    install assimp-utils=5.2.5~ds0-1+b1 libassimp5=5.2.5~ds0-1+b1 >apt.log 2>&1 || { cat apt.log; exit 1; }
for package in archives/*.deb; do dpkg-deb -x "$package" root; done
libraries=$(find "$folder/root" -name '*.so*' -printf '%h\n' | sort -u | paste -sd:)
loader=$(find "$folder/root" -name 'ld-linux-x86-64.so.2' | head -1)
program() { "$loader" --library-path "$libraries" "root/usr/bin/$1" "${@:2}"; }
npm install --silent --ignore-scripts --no-audit --no-fund three@0.187.0 \
    @gltf-transform/core@4.5.1 @gltf-transform/functions@4.5.1

cat >common.mjs <<'JS'
import * as THREE from 'three';
import { Document } from '@gltf-transform/core';

export const box = new THREE.BoxGeometry(1, 1, 1);

// A box, mirrored or not, as glTF.
export function document(scale) {
  const made = new Document(), buffer = made.createBuffer();
  const accessor = (array, type) => made.createAccessor().setType(type).setArray(array.slice()).setBuffer(buffer);
  const primitive = made.createPrimitive().setIndices(accessor(box.index.array, 'SCALAR'))
    .setAttribute('POSITION', accessor(box.attributes.position.array, 'VEC3'))
    .setAttribute('NORMAL', accessor(box.attributes.normal.array, 'VEC3'));
  made.createScene().addChild(made.createNode().setScale([scale, 1, 1]).setMesh(made.createMesh().addPrimitive(primitive)));
  return made;
}
JS
cat >write.mjs <<'JS'
import { NodeIO } from '@gltf-transform/core';
import { document } from './common.mjs';
for (const scale of [1, -1]) await new NodeIO().write(`box${scale}.glb`, document(scale));
JS
cat >compare.mjs <<'JS'
import * as THREE from 'three';
import { STLExporter } from 'three/examples/jsm/exporters/STLExporter.js';
import { PLYExporter } from 'three/examples/jsm/exporters/PLYExporter.js';
import { OBJExporter } from 'three/examples/jsm/exporters/OBJExporter.js';
import { STLLoader } from 'three/examples/jsm/loaders/STLLoader.js';
import { PLYLoader } from 'three/examples/jsm/loaders/PLYLoader.js';
import { OBJLoader } from 'three/examples/jsm/loaders/OBJLoader.js';
import { clearNodeTransform } from '@gltf-transform/functions';
import { readFileSync } from 'node:fs';
import { box, document } from './common.mjs';

globalThis.requestAnimationFrame = (callback) => setTimeout(callback);

function show(name, geometry) {
  const { position, normal } = (geometry.index ? geometry.toNonIndexed() : geometry).attributes;
  const at = (attribute, i) => new THREE.Vector3().fromBufferAttribute(attribute, i);
  let volume = 0, out = 0;
  for (let i = 0; i < position.count; i++) {
    if (i % 3 === 0) volume += at(position, i).dot(at(position, i + 1).cross(at(position, i + 2)));
    out += at(position, i).dot(at(normal, i));
  }
  console.log(`${name}: triangles ${volume > 0 ? 'out' : 'in'}, normals ${out > 0 ? 'out' : 'in'}`);
}

const parse = {
  stl: (text) => new STLLoader().parse(text),
  ply: (text) => new PLYLoader().parse(text),
  obj: (text) => new OBJLoader().parse(text).children[0].geometry,
};
for (const scale of [1, -1]) {
  const mesh = new THREE.Mesh(box, new THREE.MeshBasicMaterial());
  mesh.scale.x = scale;
  mesh.updateMatrixWorld(true);
  show(`scale ${scale}, three.js, applyMatrix4`, box.clone().applyMatrix4(mesh.matrixWorld));
  show(`scale ${scale}, three.js, stl`, parse.stl(new STLExporter().parse(mesh)));
  show(`scale ${scale}, three.js, ply`, parse.ply(await new Promise((done) => new PLYExporter().parse(mesh, done, {}))));
  show(`scale ${scale}, three.js, obj`, parse.obj(new OBJExporter().parse(mesh)));
  for (const format of Object.keys(parse))
    show(`scale ${scale}, assimp, ${format}`, parse[format](readFileSync(`box${scale}.${format}`, 'utf8')));
  const node = clearNodeTransform(document(scale).getRoot().listNodes()[0]);
  const primitive = node.getMesh().listPrimitives()[0], baked = new THREE.BufferGeometry();
  baked.setAttribute('position', new THREE.BufferAttribute(primitive.getAttribute('POSITION').getArray(), 3));
  baked.setAttribute('normal', new THREE.BufferAttribute(primitive.getAttribute('NORMAL').getArray(), 3));
  show(`scale ${scale}, glTF-Transform`, baked.setIndex(Array.from(primitive.getIndices().getArray())));
}
JS
node write.mjs
for scale in 1 -1; do
    for format in stl ply obj; do program assimp export "box$scale.glb" "box$scale.$format" >/dev/null; done
done
node compare.mjs | tee seen

diff - seen <<'END'
scale 1, three.js, applyMatrix4: triangles out, normals out
scale 1, three.js, stl: triangles out, normals out
scale 1, three.js, ply: triangles out, normals out
scale 1, three.js, obj: triangles out, normals out
scale 1, assimp, stl: triangles out, normals out
scale 1, assimp, ply: triangles out, normals out
scale 1, assimp, obj: triangles out, normals out
scale 1, glTF-Transform: triangles out, normals out
scale -1, three.js, applyMatrix4: triangles in, normals out
scale -1, three.js, stl: triangles in, normals in
scale -1, three.js, ply: triangles in, normals out
scale -1, three.js, obj: triangles in, normals out
scale -1, assimp, stl: triangles in, normals out
scale -1, assimp, ply: triangles in, normals out
scale -1, assimp, obj: triangles in, normals out
scale -1, glTF-Transform: triangles out, normals out
END
