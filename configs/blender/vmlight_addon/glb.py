# SPDX-License-Identifier: Apache-2.0
"""glTF binary files: positions, normals and UVs as Blender has them, to the bit (v is turned around, as glTF asks)."""
import json
import struct

import numpy

HEADER = struct.Struct("<4sII")
CHUNK = struct.Struct("<I4s")
Y_UP = (1, 0, 0, 0, 0, 0, -1, 0, 0, 1, 0, 0, 0, 0, 0, 1)  # columns: (x, y, z) becomes (x, z, -y)
FLOAT, UINT32 = 5126, 5125


class Part:
    """One object. Arrays of floats, a row a vertex; triangles, a row each, in the order of `materials`.

    @param matrix: 16 numbers by columns, to Blender's space
    @param materials: [(name, triangles)]"""

    def __init__(self, name, matrix, positions, normals, uvs, materials):
        self.name, self.matrix = name, matrix
        self.positions, self.normals, self.uvs, self.materials = positions, normals, uvs, materials

    @property
    def triangle_count(self):
        return sum(len(triangles) for _, triangles in self.materials)


class _Buffer:
    def __init__(self):
        self.chunks, self.size, self.views, self.accessors = [], 0, [], []

    def add(self, array, component, kind, bounds=False):
        array = numpy.ascontiguousarray(array, numpy.float32 if component == FLOAT else numpy.uint32)
        accessor = {"bufferView": len(self.views), "componentType": component, "type": kind,
                    "count": array.size if kind == "SCALAR" else len(array)}
        if bounds:
            accessor.update(min=[float(x) for x in array.min(axis=0)], max=[float(x) for x in array.max(axis=0)])
        self.views.append({"buffer": 0, "byteOffset": self.size, "byteLength": array.nbytes})
        self.accessors.append(accessor)
        self.chunks.append(array.tobytes())
        self.size += array.nbytes
        return len(self.accessors) - 1


def write(path, parts, colors=None):
    """Parts below one node that turns z up to y up.

    @param colors: of materials by name: linear R, G, B, A; others are white"""
    buffer, materials, numbers = _Buffer(), [], {}
    nodes = [{"name": "Blender", "matrix": list(Y_UP), "children": list(range(1, len(parts) + 1))}]
    meshes = []
    for part in parts:
        attributes = {"POSITION": buffer.add(part.positions, FLOAT, "VEC3", bounds=True),
                      "NORMAL": buffer.add(part.normals, FLOAT, "VEC3")}
        if part.uvs is not None:
            attributes["TEXCOORD_0"] = buffer.add(
                numpy.stack([part.uvs[:, 0], numpy.float32(1) - part.uvs[:, 1]], axis=1), FLOAT, "VEC2")
        primitives = []
        for name, triangles in part.materials:
            primitive = {"attributes": attributes, "indices": buffer.add(triangles, UINT32, "SCALAR")}
            if name:
                if name not in numbers:
                    numbers[name] = len(materials)
                    color = [float(x) for x in (colors or {}).get(name, (1, 1, 1, 1))]
                    materials.append({"name": name, "pbrMetallicRoughness": {"baseColorFactor": color, "metallicFactor": 0}})
                primitive["material"] = numbers[name]
            primitives.append(primitive)
        nodes.append({"name": part.name, "mesh": len(meshes), "matrix": [float(x) for x in part.matrix]})
        meshes.append({"name": part.name, "primitives": primitives})
    tree = {"asset": {"version": "2.0", "generator": "vmlight's add-on for Blender"}, "scene": 0, "scenes": [{"nodes": [0]}],
            "nodes": nodes, "meshes": meshes, "accessors": buffer.accessors, "bufferViews": buffer.views,
            "buffers": [{"byteLength": buffer.size}]}
    if materials:
        tree["materials"] = materials
    text = json.dumps(tree, ensure_ascii=False).encode()
    text += b" " * (-len(text) % 4)
    with open(path, "wb") as file:
        file.write(HEADER.pack(b"glTF", 2, HEADER.size + 2 * CHUNK.size + len(text) + buffer.size))
        file.write(CHUNK.pack(len(text), b"JSON") + text + CHUNK.pack(buffer.size, b"BIN\0"))
        for chunk in buffer.chunks:
            file.write(chunk)


def read_uvs(path):
    """The UVs of the corners of a file that makevismap --write-mesh made: three rows a triangle, v up."""
    with open(path, "rb") as file:
        data = file.read()
    length = CHUNK.unpack_from(data, HEADER.size)[0]
    start = HEADER.size + CHUNK.size
    tree = json.loads(data[start:start + length])
    body = start + length + CHUNK.size

    def array(number, columns):
        accessor = tree["accessors"][number]
        view = tree["bufferViews"][accessor["bufferView"]]
        kind = numpy.float32 if accessor["componentType"] == FLOAT else numpy.uint32
        first = body + view.get("byteOffset", 0) + accessor.get("byteOffset", 0)
        return numpy.frombuffer(data, kind, accessor["count"] * columns, first).reshape(-1, columns)

    primitives = tree["meshes"][0]["primitives"]
    corners = numpy.concatenate([array(p["attributes"]["TEXCOORD_0"], 2)[array(p["indices"], 1)[:, 0]] for p in primitives])
    return numpy.stack([corners[:, 0], numpy.float32(1) - corners[:, 1]], axis=1)
