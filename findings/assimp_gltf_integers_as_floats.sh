#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# assimp 5.2.5 and gltfpack 0.18 (Debian 12's assimp-utils and libassimp5 5.2.5~ds0-1+b1, gltfpack 0.18+dfsg-2).
#
# assimp reads positions and UVs of glTF as floats, whatever their type: the bits of shorts and bytes are taken for
# those of floats. Without a warning, UVs stored as normalized shorts or bytes, which glTF 2.0 allows without any extension,
# become nonsense near 2 or 0. What gltfpack writes by default (KHR_mesh_quantization, which the file requires) becomes a
# speck at the origin. Colours are converted. assimp does not look at extensionsRequired. A request to
# fix this was open in assimp's repository in August 2026.
#
# Needs apt-get with the archive of Debian 12 on amd64; installs nothing: unpacks the packages in a temporary folder.
# Exits with 1 if the results differ from these.
set -euo pipefail
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cd "$folder"
mkdir -p archives/partial root
touch status # as if nothing were installed, so that all that the programs need is downloaded
apt-get -qq -y --no-install-recommends --download-only -o Debug::NoLocking=1 -o APT::Sandbox::User=root \
    -o Dir::State::status="$folder/status" -o Dir::Cache::archives="$folder/archives" \
    install assimp-utils=5.2.5~ds0-1+b1 libassimp5=5.2.5~ds0-1+b1 gltfpack=0.18+dfsg-2 \
    >apt.log 2>&1 || { cat apt.log; exit 1; }
for package in archives/*.deb; do dpkg-deb -x "$package" root; done
libraries=$(find "$folder/root" -name '*.so*' -printf '%h\n' | sort -u | paste -sd:)
loader=$(find "$folder/root" -name 'ld-linux-x86-64.so.2' | head -1)
program() { "$loader" --library-path "$libraries" "root/usr/bin/$1" "${@:2}"; }

# One triangle, with UVs (.25, .25), (.75, .25), (.25, .75): as floats, normalized shorts, and normalized bytes.
{
    printf '\0\0\0\0\0\0\0\0\0\0\0\0\0\0\x80\x3f\0\0\0\0\0\0\0\0\0\0\0\0\0\0\x80\x3f\0\0\0\0'
    printf '\0\0\x80\x3e\0\0\x80\x3e\0\0\x40\x3f\0\0\x80\x3e\0\0\x80\x3e\0\0\x40\x3f'
    printf '\x00\x40\x00\x40\xff\xbf\x00\x40\x00\x40\xff\xbf'
    printf '\x40\x40\0\0\xbf\x40\0\0\x40\xbf\0\0'
} >data.bin
gltf() {
    cat <<JSON
{ "asset": { "version": "2.0" }, "scene": 0, "scenes": [{ "nodes": [0] }], "nodes": [{ "mesh": 0 }],
  "meshes": [{ "primitives": [{ "attributes": { "POSITION": 0, "TEXCOORD_0": 1 }, "material": 0 }] }],
  "materials": [{ "pbrMetallicRoughness": { "baseColorTexture": { "index": 0 } } }],
  "textures": [{ "source": 0 }], "images": [{ "uri": "texture.png" }],
  "accessors": [
    { "bufferView": 0, "componentType": 5126, "count": 3, "type": "VEC3", "min": [0, 0, 0], "max": [1, 1, 0] },
    { "bufferView": $1, "componentType": $2, "normalized": $3, "count": 3, "type": "VEC2" }],
  "bufferViews": [
    { "buffer": 0, "byteOffset": 0, "byteLength": 36, "target": 34962 },
    { "buffer": 0, "byteOffset": 36, "byteLength": 24, "target": 34962 },
    { "buffer": 0, "byteOffset": 60, "byteLength": 12, "target": 34962 },
    { "buffer": 0, "byteOffset": 72, "byteLength": 12, "byteStride": 4, "target": 34962 }],
  "buffers": [{ "byteLength": 84, "uri": "data.bin" }] }
JSON
}
gltf 1 5126 false >floats.gltf
gltf 2 5123 true >shorts.gltf
gltf 3 5121 true >bytes.gltf
program gltfpack -i floats.gltf -o packed.gltf >/dev/null

{
    echo "packed.gltf requires: $(grep -o '"extensionsRequired":[^]]*' packed.gltf | grep -o 'KHR[a-z_]*')"
    for file in floats shorts bytes packed; do
        program assimp export $file.gltf $file.obj >/dev/null
        echo "$file:$(awk '/^v / { printf " (%.4g, %.4g)", $2, $3 }' $file.obj)," \
            "UVs$(awk '/^vt/ { printf " (%.4g, %.4g)", $2, $3 }' $file.obj)"
    done
} | tee seen

# In OBJ, v counts from the bottom: .75 is the .25 of glTF.
diff - seen <<'END'
packed.gltf requires: KHR_mesh_quantization
floats: (0, 0) (1, 0) (0, 1), UVs (0.25, 0.75) (0.75, 0.75) (0.25, 0.25)
shorts: (0, 0) (1, 0) (0, 1), UVs (2.004, 1) (2.012, 1) (-1.994, 1)
bytes: (0, 0) (1, 0) (0, 1), UVs (2.305e-41, 1) (2.323e-41, 1) (6.861e-41, 1)
packed: (0, 0) (1.401e-45, 0) (0.0001216, 0), UVs (0, 1) (5.738e-42, 1) (2.514e-29, 1)
END
