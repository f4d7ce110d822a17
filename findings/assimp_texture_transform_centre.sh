#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# assimp 5.2.5 (Debian 12's libassimp-dev and libassimp5 5.2.5~ds0-1+b1).
#
# Two parts of assimp disagree on glTF's KHR_texture_transform, with which atlases and tilings are stored: offset and scale
# of UVs, u s + t. Its importer makes an aiUVTransform that says the same. Its own step for these, which is documented as the
# way for programs that know no transforms, aiProcess_TransformUVCoords, moves first and then scales around the middle of
# the texture: s (u + t - 1/2) + 1/2. So a texture tiled twice is off by half a tile; tiled three times, by a whole
# one, which looks right; a part of an atlas shows its neighbours. There is no warning, and offsets alone are right.
# A request to fix the importer's side was open in assimp's repository in 2026.
#
# Needs g++, and apt-get with the archive of Debian 12 on amd64; installs nothing: unpacks the packages in a temporary
# folder. Exits with 1 if the UVs come out in another way than written here.
set -euo pipefail
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cd "$folder"
mkdir -p archives/partial root
touch status # as if nothing were installed, so that all that the programs need is downloaded
apt-get -qq -y --no-install-recommends --download-only -o Debug::NoLocking=1 -o APT::Sandbox::User=root \
    -o Dir::State::status="$folder/status" -o Dir::Cache::archives="$folder/archives" \
    install libassimp5=5.2.5~ds0-1+b1 libassimp-dev=5.2.5~ds0-1+b1 >apt.log 2>&1 || { cat apt.log; exit 1; }
for package in archives/*.deb; do dpkg-deb -x "$package" root; done
libraries=$(find "$folder/root" -name '*.so*' -printf '%h\n' | sort -u | paste -sd:)
loader=$(find "$folder/root" -name 'ld-linux-x86-64.so.2' | head -1)
program() { "$loader" --library-path "$libraries" "$1" "${@:2}"; }

cat >uvs.cpp <<'CPP'
#include <assimp/Importer.hpp>
#include <assimp/material.h>
#include <assimp/postprocess.h>
#include <assimp/scene.h>
#include <cstdio>
int main(int, char** argv)
{
    // The triangle's last corner, UV (.25, .25) before the transform. assimp's v counts from the bottom.
    for (unsigned step : { 0u, unsigned(aiProcess_TransformUVCoords) }) {
        Assimp::Importer importer;
        const aiScene* scene = importer.ReadFile(argv[1], step);
        if (!scene)
            return 1;
        const aiMesh& mesh = *scene->mMeshes[0];
        aiVector3D uv = mesh.mTextureCoords[0][2];
        aiUVTransform transform;
        if (!step && scene->mMaterials[0]->Get(AI_MATKEY_UVTRANSFORM_DIFFUSE(0), transform) == AI_SUCCESS) {
            uv.x = uv.x * transform.mScaling.x + transform.mTranslation.x;
            uv.y = uv.y * transform.mScaling.y + transform.mTranslation.y;
        }
        std::printf(", %s (%.2f, %.2f)", step ? "the step" : "the importer's transform", uv.x, 1 - uv.y);
    }
    std::puts("");
}
CPP
g++ -std=c++17 uvs.cpp -I root/usr/include root/usr/lib/x86_64-linux-gnu/libassimp.so.5 -Wl,--allow-shlib-undefined -o uvs

# A triangle with the UVs (0, 0), (1, 0), (.25, .25)
printf '\0\0\0\0\0\0\0\0\0\0\0\0\0\0\x80\x3f\0\0\0\0\0\0\0\0\0\0\0\0\0\0\x80\x3f\0\0\0\0' >data.bin
printf '\0\0\0\0\0\0\0\0\0\0\x80\x3f\0\0\0\0\0\0\x80\x3e\0\0\x80\x3e' >>data.bin
gltf() {
    cat <<JSON
{ "asset": { "version": "2.0" }, "scene": 0, "scenes": [{ "nodes": [0] }], "nodes": [{ "mesh": 0 }],
  "extensionsUsed": ["KHR_texture_transform"],
  "meshes": [{ "primitives": [{ "attributes": { "POSITION": 0, "TEXCOORD_0": 1 }, "material": 0 }] }],
  "materials": [{ "pbrMetallicRoughness": { "baseColorTexture": { "index": 0, "extensions": {
    "KHR_texture_transform": { "offset": [$1, $1], "scale": [$2, $2] } } } } }],
  "textures": [{ "source": 0 }], "images": [{ "uri": "texture.png" }],
  "accessors": [
    { "bufferView": 0, "componentType": 5126, "count": 3, "type": "VEC3", "min": [0, 0, 0], "max": [1, 1, 0] },
    { "bufferView": 1, "componentType": 5126, "count": 3, "type": "VEC2" }],
  "bufferViews": [
    { "buffer": 0, "byteOffset": 0, "byteLength": 36, "target": 34962 },
    { "buffer": 0, "byteOffset": 36, "byteLength": 24, "target": 34962 }],
  "buffers": [{ "byteLength": 60, "uri": "data.bin" }] }
JSON
}
for transform in '0 1' '0.25 1' '0 2' '0 3' '0.25 0.5'; do
    # shellcheck disable=SC2086
    gltf $transform >scene.gltf
    awk -v transform="$transform" 'BEGIN { split(transform, t, " ")
        printf "offset %s, scale %s: the extension (%.2f, %.2f)", t[1], t[2], .25 * t[2] + t[1], .25 * t[2] + t[1] }'
    program ./uvs scene.gltf
done | tee seen

diff - seen <<'END'
offset 0, scale 1: the extension (0.25, 0.25), the importer's transform (0.25, 0.25), the step (0.25, 0.25)
offset 0.25, scale 1: the extension (0.50, 0.50), the importer's transform (0.50, 0.50), the step (0.50, 0.50)
offset 0, scale 2: the extension (0.50, 0.50), the importer's transform (0.50, 0.50), the step (0.00, 0.00)
offset 0, scale 3: the extension (0.75, 0.75), the importer's transform (0.75, 0.75), the step (-0.25, -0.25)
offset 0.25, scale 0.5: the extension (0.38, 0.38), the importer's transform (0.38, 0.38), the step (0.50, 0.25)
END
