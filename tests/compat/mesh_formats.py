# SPDX-License-Identifier: Apache-2.0
"""Writes the mesh of an OBJ file in every format that vmlight reads, for same_pixels.py."""
import base64
import json
import struct


def read_obj(path):
    """The corners of the triangles of an OBJ file, three a triangle: (position, texture coordinate, normal or None)."""
    tables = {"v": [], "vt": [], "vn": []}
    corners = []
    with open(path) as file:
        for line in file:
            words = line.split()
            if not words:
                continue
            if words[0] in tables:
                tables[words[0]].append(tuple(float(word) for word in words[1:]))
            elif words[0] == "f":
                assert len(words) == 4, line
                for corner in words[1:]:
                    v, vt, vn = (corner.split("/") + ["", ""])[:3]
                    corners.append((tables["v"][int(v) - 1], tables["vt"][int(vt) - 1][:2],
                                    tables["vn"][int(vn) - 1] if vn else None))
    return corners


def write_obj(path, corners):
    """With the normals left out where there are none."""
    with open(path, "w") as file:
        for position, uv, normal in corners:
            file.write("v %.9g %.9g %.9g\n" % position + "vt %.9g %.9g\n" % uv)
            if normal:
                file.write("vn %.9g %.9g %.9g\n" % normal)
        for i in range(1, len(corners), 3):
            file.write("f " + " ".join(f"{k}/{k}/{k}" if corners[0][2] else f"{k}/{k}" for k in range(i, i + 3)) + "\n")


def write_ply(path, corners, binary, number="float"):
    """@param number: float or double, of the coordinates"""
    names = ["x", "y", "z", "nx", "ny", "nz", "s", "t"]
    types = [number] * 3 + ["float"] * 5
    form = "binary_little_endian" if binary else "ascii"
    header = f"ply\nformat {form} 1.0\nelement vertex {len(corners)}\n"
    header += "".join(f"property {kind} {name}\n" for kind, name in zip(types, names))
    header += f"element face {len(corners) // 3}\nproperty list uchar int vertex_indices\nend_header\n"
    pack = "<" + "".join("d" if kind == "double" else "f" for kind in types)
    with open(path, "wb") as file:
        file.write(header.encode())
        for position, uv, normal in corners:
            values = (*position, *normal, *uv)
            file.write(struct.pack(pack, *values) if binary
                       else (" ".join("%.9g" % value for value in values) + "\n").encode())
        for i in range(0, len(corners), 3):
            file.write(struct.pack("<B3i", 3, i, i + 1, i + 2) if binary else f"3 {i} {i + 1} {i + 2}\n".encode())


def write_stl(path, corners, binary):
    triangles = [[corner[0] for corner in corners[i:i + 3]] for i in range(0, len(corners), 3)]
    with open(path, "wb") as file:
        if binary:
            file.write(b"\0" * 80 + struct.pack("<I", len(triangles)))
            for triangle in triangles:
                file.write(struct.pack("<12fH", 0, 0, 0, *(x for point in triangle for x in point), 0))
            return
        file.write(b"solid mesh\n")
        for triangle in triangles:
            points = "".join("vertex %.9g %.9g %.9g\n" % point for point in triangle)
            file.write(f"facet normal 0 0 0\nouter loop\n{points}endloop\nendfacet\n".encode())
        file.write(b"endsolid mesh\n")


def write_gltf(path, corners, node, glb):
    """@param node: its transformation, as glTF writes it. A second set of texture coordinates is the first, halved."""
    flipped = [(uv[0], 1 - uv[1]) for _, uv, _ in corners]
    arrays = [("POSITION", "VEC3", [position for position, _, _ in corners]),
              ("NORMAL", "VEC3", [normal for _, _, normal in corners]), ("TEXCOORD_0", "VEC2", flipped),
              ("TEXCOORD_1", "VEC2", [(u / 2, v / 2) for u, v in flipped])]
    binary, views, accessors = b"", [], []
    for _, kind, rows in arrays:
        data = b"".join(struct.pack(f"<{len(row)}f", *row) for row in rows)
        views.append({"buffer": 0, "byteOffset": len(binary), "byteLength": len(data)})
        accessors.append({"bufferView": len(accessors), "componentType": 5126, "count": len(rows), "type": kind})
        binary += data
    positions = list(zip(*arrays[0][2]))
    accessors[0].update(min=[min(axis) for axis in positions], max=[max(axis) for axis in positions])
    buffer = {"byteLength": len(binary)}
    if not glb:
        buffer["uri"] = "data:application/octet-stream;base64," + base64.b64encode(binary).decode()
    tree = {"asset": {"version": "2.0"}, "scene": 0, "scenes": [{"nodes": [0]}],
            "nodes": [{"name": "top", "children": [1], **node}, {"mesh": 0}],
            "meshes": [{"primitives": [{"attributes": {name: i for i, (name, _, _) in enumerate(arrays)}}]}],
            "accessors": accessors, "bufferViews": views, "buffers": [buffer]}
    text = json.dumps(tree).encode()
    if glb:
        text += b" " * (-len(text) % 4)
        binary += b"\0" * (-len(binary) % 4)
        text = (struct.pack("<4sII", b"glTF", 2, 28 + len(text) + len(binary)) + struct.pack("<I4s", len(text), b"JSON")
                + text + struct.pack("<I4s", len(binary), b"BIN\0") + binary)
    with open(path, "wb") as file:
        file.write(text)


def write_dae(path, corners, up_axis, matrix):
    """@param matrix: 16 numbers, row major, of its node"""
    arrays = [("POSITION", "XYZ", [corner[0] for corner in corners]), ("NORMAL", "XYZ", [corner[2] for corner in corners]),
              ("TEXCOORD", "ST", [corner[1] for corner in corners])]
    sources = ""
    for name, axes, rows in arrays:
        numbers = " ".join("%.9g" % x for row in rows for x in row)
        params = "".join(f'<param name="{axis}" type="float"/>' for axis in axes)
        sources += (f'<source id="{name}"><float_array id="{name}-a" count="{len(rows) * len(axes)}">{numbers}'
                    f'</float_array><technique_common><accessor source="#{name}-a" count="{len(rows)}" '
                    f'stride="{len(axes)}">{params}</accessor></technique_common></source>')
    indices = " ".join(map(str, range(len(corners))))
    with open(path, "w") as file:
        file.write(f"""<?xml version="1.0" encoding="utf-8"?>
<COLLADA xmlns="http://www.collada.org/2005/11/COLLADASchema" version="1.4.1">
<asset><unit name="centimeter" meter="0.01"/><up_axis>{up_axis}</up_axis></asset>
<library_geometries><geometry id="g"><mesh>{sources}
<vertices id="v"><input semantic="POSITION" source="#POSITION"/></vertices>
<triangles count="{len(corners) // 3}"><input semantic="VERTEX" source="#v" offset="0"/>
<input semantic="NORMAL" source="#NORMAL" offset="0"/><input semantic="TEXCOORD" source="#TEXCOORD" offset="0" set="0"/>
<p>{indices}</p></triangles></mesh></geometry></library_geometries>
<library_visual_scenes><visual_scene id="s"><node id="n"><matrix>{" ".join(map(str, matrix))}</matrix>
<instance_geometry url="#g"/></node></visual_scene></library_visual_scenes>
<scene><instance_visual_scene url="#s"/></scene></COLLADA>
""")


class Long(int):
    """An FBX id, of 64 bits."""


def fbx_text(name, properties, records):
    def text(value):
        if isinstance(value, list):
            return f"*{len(value)} {{ a: {','.join('%.9g' % x for x in value)} }}"
        return f'"{value}"' if isinstance(value, str) else str(value)

    inner = "".join(fbx_text(*record) for record in records)
    return f"{name}: {', '.join(map(text, properties))}" + (f" {{\n{inner}}}\n" if records else "\n")


def fbx_binary(name, properties, records, start):
    def array(value):
        kind = "d" if isinstance(value[0], float) else "i"
        data = struct.pack(f"<{len(value)}{kind}", *value)
        return kind.encode() + struct.pack("<III", len(value), 0, len(data)) + data

    packed = b""
    for value in properties:
        if isinstance(value, list):
            packed += array(value)
        elif isinstance(value, str):
            packed += b"S" + struct.pack("<I", len(value)) + value.encode()
        elif isinstance(value, float):
            packed += b"D" + struct.pack("<d", value)
        else:
            packed += b"L" + struct.pack("<q", value) if isinstance(value, Long) else b"I" + struct.pack("<i", value)
    first = start + 13 + len(name) + len(packed)
    inner = b""
    for record in records:
        inner += fbx_binary(*record, first + len(inner))
    inner += b"\0" * 13 if records else b""
    end = first + len(inner)
    return struct.pack("<IIIB", end, len(properties), len(packed), len(name)) + name.encode() + packed + inner


def write_fbx(path, corners, binary, scale):
    """@param scale: of its node"""
    def layer(kind, numbers, of):
        return (kind, [0], [("Version", [101], []), ("Name", [""], []),
                            ("MappingInformationType", ["ByPolygonVertex"], []),
                            ("ReferenceInformationType", ["Direct"], []), (of, [numbers], [])])

    def full(kind, name):
        return name + "\0\1" + kind if binary else kind + "::" + name

    def flat(k):
        return [float(x) for corner in corners for x in corner[k]]

    indices = [~i if i % 3 == 2 else i for i in range(len(corners))]
    layers = [("Version", [100], [])] + [
        ("LayerElement", [], [("Type", [kind], []), ("TypedIndex", [0], [])])
        for kind in ("LayerElementNormal", "LayerElementUV")]
    geometry = ("Geometry", [Long(1), full("Geometry", "mesh"), "Mesh"], [
        ("Vertices", [flat(0)], []), ("PolygonVertexIndex", [indices], []), ("GeometryVersion", [124], []),
        layer("LayerElementNormal", flat(2), "Normals"), layer("LayerElementUV", flat(1), "UV"), ("Layer", [0], layers)])
    model = ("Model", [Long(2), full("Model", "mesh"), "Mesh"], [
        ("Version", [232], []),
        ("Properties70", [], [("P", ["Lcl Scaling", "Lcl Scaling", "", "A", scale, scale, scale], []),
                              ("P", ["Lcl Rotation", "Lcl Rotation", "", "A", 0.0, 30.0, 0.0], [])])])
    records = [("FBXHeaderExtension", [], [("FBXVersion", [7400], [])]), ("Objects", [], [geometry, model]),
               ("Connections", [], [("C", ["OO", Long(1), Long(2)], []), ("C", ["OO", Long(2), Long(0)], [])])]
    head = b"Kaydara FBX Binary  \0\x1a\0" + struct.pack("<I", 7400) if binary else b"; FBX 7.4.0 project file\n"
    for record in records:
        head += fbx_binary(*record, len(head)) if binary else fbx_text(*record).encode()
    with open(path, "wb") as file:
        file.write(head + (b"\0" * 13 if binary else b""))


def write_all(corners):
    """Every format, into the current folder; returns the files' names. All but STL have texture coordinates."""
    turned = [0.8, 0, 0.6, 1, 0, 1, 0, 2, -0.6, 0, 0.8, 3, 0, 0, 0, 1]
    write_ply("float.ply", corners, binary=False)
    write_ply("binary.ply", corners, binary=True)
    write_ply("double.ply", corners, binary=True, number="double")
    write_stl("text.stl", corners, binary=False)
    write_stl("binary.stl", corners, binary=True)
    write_gltf("mesh.gltf", corners, {"rotation": [0, 0.6, 0, 0.8], "scale": [1, 2, 1]}, glb=False)
    write_gltf("mesh.glb", corners, {"translation": [10, 20, 30]}, glb=True)
    write_dae("y.dae", corners, "Y_UP", turned)
    write_dae("z.dae", corners, "Z_UP", turned)
    write_fbx("text.fbx", corners, binary=False, scale=0.5)
    write_fbx("binary.fbx", corners, binary=True, scale=2.0)
    return ["float.ply", "binary.ply", "double.ply", "mesh.gltf", "mesh.glb", "y.dae", "z.dae", "text.fbx", "binary.fbx"]
