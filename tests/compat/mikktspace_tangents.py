#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Normals that makevismap takes from a tangent-space normal map, against tangents that npm's mikktspace (MikkTSpace as
WebAssembly) makes for the same mesh.

Run as: mikktspace_tangents.py MAKEVISMAP MESH...
Each mesh is written by --write-mesh, with normals and UVs as they are baked, and baked with normal maps of one leaning
vector each. At texel centres the two must agree within 1e-4 (RMS), and nowhere be 0.01 apart: the rasterizer rounds UVs to 1/256 of
a texel, which moves the weights of the corners of small triangles. Needs node with npm, and the internet for one pinned package,
which it installs in a temporary folder."""
import json
import os
import subprocess
import sys
import tempfile

import numpy
import OpenImageIO as oiio

PACKAGE = "mikktspace@1.1.1"
SIDE = 1024
BOUND, FARTHEST = 1e-4, 1e-2
LEANING = [(0.6, 0, 0.8), (0, 0.6, 0.8), (-0.48, 0.36, 0.8)]
NODE = """
const fs = require("fs"), { generateTangents } = require("mikktspace");
const given = JSON.parse(fs.readFileSync("corners.json"));
const floats = name => new Float32Array(given[name]);
fs.writeFileSync("tangents.json", JSON.stringify(Array.from(generateTangents(floats("positions"), floats("normals"), floats("uvs")))));
"""


def read_obj(path):
    """Tables of v, vn and vt, and the indices of all triangles: [triangles, 3, v vt vn], as far as the file has them."""
    tables, faces = {"v": [], "vn": [], "vt": []}, []
    with open(path, encoding="utf-8") as file:
        for line in file:
            word, *rest = line.split() or [""]
            if word in tables:
                tables[word].append([float(x) for x in rest])
            elif word == "f":
                faces.append([[int(x) - 1 for x in corner.split("/") if x] for corner in rest])
    return {name: numpy.array(table) for name, table in tables.items()}, numpy.array(faces)


def corners_of(path):
    """Positions, normals and uvs of all triangles of an OBJ: [triangles, 3, ...]."""
    tables, faces = read_obj(path)
    return [tables[name][faces[:, :, column]] for name, column in (("v", 0), ("vn", 2), ("vt", 1))]


def tangents_of(corners, folder):
    positions, normals, uvs = corners
    with open(os.path.join(folder, "corners.json"), "w", encoding="utf-8") as file:
        json.dump({"positions": positions.ravel().tolist(), "normals": normals.ravel().tolist(),
                   "uvs": uvs[:, :, :2].ravel().tolist()}, file)
    subprocess.run(["node", "-e", NODE], cwd=folder, check=True)
    with open(os.path.join(folder, "tangents.json"), encoding="utf-8") as file:
        return numpy.array(json.load(file)).reshape(-1, 3, 4)


def mapped_directions(corners, tangents, leaning):
    """[SIDE, SIDE, 3]: x T + y B + z N of each texel, not normalised; not a number where no triangle is, or several are."""
    _, normals, uvs = corners
    image, seen = numpy.full((SIDE, SIDE, 3), numpy.nan), numpy.zeros((SIDE, SIDE), int)
    for k in range(len(uvs)):
        (ax, ay), (bx, by), (cx, cy) = uvs[k, :, :2] * SIDE
        area = (bx - ax) * (cy - ay) - (by - ay) * (cx - ax)
        if area == 0:
            continue
        xs = numpy.arange(max(int(min(ax, bx, cx)) - 1, 0), min(int(max(ax, bx, cx)) + 2, SIDE))
        ys = numpy.arange(max(int(min(ay, by, cy)) - 1, 0), min(int(max(ay, by, cy)) + 2, SIDE))
        x, y = numpy.meshgrid(xs + 0.5, ys + 0.5)
        b = ((x - ax) * (cy - ay) - (y - ay) * (cx - ax)) / area
        c = ((bx - ax) * (y - ay) - (by - ay) * (x - ax)) / area
        weights = numpy.stack([1 - b - c, b, c], axis=-1)
        inside = (weights >= 0).all(axis=-1)
        weights = weights[inside]
        columns, rows = (x[inside] - 0.5).astype(int), SIDE - 1 - (y[inside] - 0.5).astype(int)
        normal, tangent = weights @ normals[k], weights @ tangents[k, :, :3]
        bitangent = numpy.cross(normal, tangent) * tangents[k, 0, 3]
        image[rows, columns] = tangent * leaning[0] + bitangent * leaning[1] + normal * leaning[2]
        seen[rows, columns] += 1
    image[seen != 1] = numpy.nan
    return image


def expected_normals(corners, tangents, leaning):
    mapped = mapped_directions(corners, tangents, leaning)
    return mapped / numpy.linalg.norm(mapped, axis=-1, keepdims=True)


def check(makevismap, mesh, folder):
    written = os.path.join(folder, "written.obj")
    common = ["--resolution", str(SIDE), "--samples", "1", "--margin", "0", "--quiet"]
    subprocess.run([makevismap, mesh, "--write-mesh", written, "-o", os.path.join(folder, "plain.exr"), *common], check=True)
    corners = corners_of(written)
    tangents = tangents_of(corners, folder)
    good, texels = True, 0
    for leaning in LEANING:
        image = oiio.ImageBuf(oiio.ImageSpec(4, 4, 3, "float"))
        oiio.ImageBufAlgo.fill(image, tuple((x + 1) / 2 for x in leaning))
        image.write(os.path.join(folder, "leaning.exr"))
        map_path = os.path.join(folder, "mapped.exr")
        subprocess.run([makevismap, mesh, "--normal-map", os.path.join(folder, "leaning.exr"), "--channels", "normal,coverage",
                        "-o", map_path, *common], check=True)
        made = oiio.ImageBuf(map_path)
        names = list(made.spec().channelnames)
        pixels = made.get_pixels(oiio.FLOAT)
        ours = pixels[..., [names.index("normal." + axis) for axis in "xyz"]]
        theirs = expected_normals(corners, tangents, leaning)
        both = (pixels[..., names.index("coverage")] == 1) & numpy.isfinite(theirs[..., 0])
        apart = numpy.linalg.norm(ours - theirs, axis=-1)[both]
        texels += int(both.sum())
        rms = numpy.sqrt((apart ** 2).mean())
        good = good and apart.max() <= FARTHEST and rms <= BOUND
        print(f"{os.path.basename(mesh)} {leaning}: {int(both.sum())} texels, apart by {rms:.2g} (RMS), at most {apart.max():.2g}")
    return good and texels > 0


def main():
    with tempfile.TemporaryDirectory() as folder:
        subprocess.run(["npm", "install", "--no-audit", "--no-fund", "--silent", PACKAGE], cwd=folder, check=True)
        results = [check(os.path.abspath(sys.argv[1]), os.path.abspath(mesh), folder) for mesh in sys.argv[2:]]
    sys.exit(0 if results and all(results) else 1)


if __name__ == "__main__":
    main()
