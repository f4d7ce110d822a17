// SPDX-License-Identifier: Apache-2.0
// Writes a glTF file as other programs compress it, and each of those as glTF-Transform decodes it.
//   node gltf_variants.mjs FILE.glb FOLDER     from a folder with the packages that gltf_transform.py names
import { NodeIO } from '@gltf-transform/core';
import { ALL_EXTENSIONS, EXTMeshoptCompression, KHRDracoMeshCompression } from '@gltf-transform/extensions';
import { dequantize, draco, meshopt, quantize, sparse } from '@gltf-transform/functions';
import draco3d from 'draco3dgltf';
import { MeshoptDecoder, MeshoptEncoder } from 'meshoptimizer';
import { execFileSync } from 'node:child_process';
import { copyFileSync } from 'node:fs';

const [file, folder] = process.argv.slice(2);
await MeshoptDecoder.ready;
await MeshoptEncoder.ready;
const io = new NodeIO().registerExtensions(ALL_EXTENSIONS).registerDependencies({
  'draco3d.decoder': await draco3d.createDecoderModule(),
  'draco3d.encoder': await draco3d.createEncoderModule(),
  'meshopt.decoder': MeshoptDecoder,
  'meshopt.encoder': MeshoptEncoder,
});
const encoders = {
  plain: [],
  quantize: [quantize()],
  sparse: [sparse()],
  meshopt: [meshopt({ encoder: MeshoptEncoder })],
  meshopt_high: [meshopt({ encoder: MeshoptEncoder, level: 'high' })],
  draco: [draco()],
};
for (const [name, transforms] of Object.entries(encoders)) {
  const document = await io.read(file);
  await document.transform(...transforms);
  await io.write(`${folder}/${name}.glb`, document);
}
copyFileSync(file, `${folder}/original.glb`);
for (const [name, flags] of [['gltfpack', ['-kn', '-km']], ['gltfpack_c', ['-kn', '-km', '-c']]])
  execFileSync('node', ['node_modules/gltfpack/cli.js', '-i', file, '-o', `${folder}/${name}.glb`, '-vtf', ...flags]);

for (const name of ['original', ...Object.keys(encoders), 'gltfpack', 'gltfpack_c']) {
  const document = await io.read(`${folder}/${name}.glb`);
  for (const extension of [EXTMeshoptCompression, KHRDracoMeshCompression])
    document.createExtension(extension).dispose();
  await document.transform(dequantize({ pattern: /.*/ }));
  await io.write(`${folder}/${name}_decoded.glb`, document);
}
