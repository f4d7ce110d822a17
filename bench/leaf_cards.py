#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""The leaves of scenes.py as cards whose texture says where the leaf is, and where light passes:

    bench/leaf_cards.py OUT_FOLDER

Writes leaf_cards.gltf, with leaf_cards.bin and leaf.png: TEXCOORD_0 is that of the leaf, TEXCOORD_1 that of the atlas (bake
with --uv-set 1). Alpha is the mode MASK. About three fifths of a card are leaf. The same bytes on every run.
"""
import json
import math
import os
import struct
import sys

from help_flag import answer_help
import png
import scenes

SIDE = 512


def leaf_alpha(x, y):
    """An ellipse with teeth, its border eight texels soft."""
    s, t = (x + 0.5) / SIDE * 2 - 1, (y + 0.5) / SIDE * 2 - 1
    radius = math.hypot(s, t * 1.2) + 0.05 * math.sin(24 * math.atan2(t, s))
    return round(255 * min(1.0, max(0.0, (0.95 - radius) * SIDE / 8 + 0.5)))


def png_of_leaf():
    return png.encode([[(60, 130, 40, leaf_alpha(x, y)) for x in range(SIDE)] for y in range(SIDE)])


class Buffer:
    def __init__(self):
        self.data, self.views, self.accessors = b"", [], []

    def add(self, rows, kind, component, code):
        """Append rows of numbers; returns the accessor's index."""
        packed = b"".join(struct.pack(f"<{len(row)}{code}", *row) for row in rows)
        self.views.append({"buffer": 0, "byteOffset": len(self.data), "byteLength": len(packed)})
        accessor = {"bufferView": len(self.views) - 1, "componentType": component, "count": len(rows), "type": kind}
        if kind == "VEC3":
            accessor["min"], accessor["max"] = ([pick(c) for c in zip(*rows)] for pick in (min, max))
        self.accessors.append(accessor)
        self.data += packed
        return len(self.accessors) - 1


def single(numbers):
    """As floats hold them: the limits that glTF asks for are exact."""
    return struct.unpack(f"<{len(numbers)}f", struct.pack(f"<{len(numbers)}f", *numbers))


def primitive(buffer, faces, material):
    positions, normals, leaf_uvs, atlas_uvs, indices = [], [], [], [], []
    for face in faces:
        first = len(positions)
        for (position, uv, normal), own in zip(face, ((0, 1), (1, 1), (1, 0), (0, 0))):
            positions.append(single(position))
            normals.append(single(normal))
            leaf_uvs.append(own)
            atlas_uvs.append((uv[0], 1 - uv[1]))  # glTF's v runs down
        indices += [(first + i,) for i in (0, 1, 2, 0, 2, 3)]
    return {"material": material, "indices": buffer.add(indices, "SCALAR", 5125, "I"),
            "attributes": {"POSITION": buffer.add(positions, "VEC3", 5126, "f"),
                           "NORMAL": buffer.add(normals, "VEC3", 5126, "f"),
                           "TEXCOORD_0": buffer.add(leaf_uvs, "VEC2", 5126, "f"),
                           "TEXCOORD_1": buffer.add(atlas_uvs, "VEC2", 5126, "f")}}


def main():
    answer_help(__doc__)
    if len(sys.argv) != 2:
        sys.exit("usage: bench/leaf_cards.py OUT_FOLDER")
    os.makedirs(sys.argv[1], exist_ok=True)
    faces = scenes.leaves().faces
    is_leaf = [scenes.length(scenes.add(face[1][0], face[0][0], -1)) < 0.3 for face in faces]
    buffer = Buffer()
    primitives = [primitive(buffer, [f for f, leaf in zip(faces, is_leaf) if leaf == wanted], int(wanted))
                  for wanted in (False, True)]
    document = {
        "asset": {"version": "2.0", "generator": "vmlight bench/leaf_cards.py"},
        "scene": 0, "scenes": [{"nodes": [0]}], "nodes": [{"mesh": 0}],
        "meshes": [{"name": "leaf_cards", "primitives": primitives}],
        "materials": [{"name": "ground"},
                      {"name": "leaf", "alphaMode": "MASK", "alphaCutoff": 0.5, "doubleSided": True,
                       "pbrMetallicRoughness": {"metallicFactor": 0, "baseColorTexture": {"index": 0}}}],
        "textures": [{"source": 0, "sampler": 0}], "images": [{"uri": "leaf.png"}],
        "samplers": [{"magFilter": 9729, "wrapS": 33071, "wrapT": 33071}],
        "accessors": buffer.accessors, "bufferViews": buffer.views,
        "buffers": [{"uri": "leaf_cards.bin", "byteLength": len(buffer.data)}],
    }
    for name, data in (("leaf_cards.gltf", json.dumps(document).encode()), ("leaf_cards.bin", buffer.data),
                       ("leaf.png", png_of_leaf())):
        with open(os.path.join(sys.argv[1], name), "wb") as file:
            file.write(data)


if __name__ == "__main__":
    main()
