#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Six meshes for measuring shading models, from open to closed, each with its own atlas:

    bench/scenes.py OUT_FOLDER

Writes object, ground, city, terrain, well_stairs and leaves, all .obj, y up, texture coordinates in [0,1] (but those of
`object`, which is tests/data/spot.obj as it is) and no texel covered twice. The same bytes on every run.
"""
import math
import os
import random
import shutil
import sys

from help_flag import answer_help

SPOT = os.path.join(os.path.dirname(os.path.abspath(__file__)), "../tests/data/spot.obj")
GAP = 2 / 256  # between charts, in the atlas


class Mesh:
    """Faces of (position, uv, normal) corners; a normal of None leaves it to the reader to make smooth ones."""

    def __init__(self):
        self.faces = []

    def add(self, corners):
        self.faces.append(corners)

    def write(self, path):
        tables = [{}, {}, {}]
        lines = []
        for face in self.faces:
            words = []
            for corner in face:
                index = [table.setdefault(tuple(part), len(table) + 1) if part is not None else ""
                         for table, part in zip(tables, corner)]
                words.append("/".join(map(str, index)).rstrip("/"))
            lines.append("f " + " ".join(words))
        with open(path, "w") as file:
            for key, table in zip(("v", "vt", "vn"), tables):
                for part in table:
                    file.write(key + "".join(f" {x:.7g}" for x in part) + "\n")
            file.write("\n".join(lines) + "\n")


def add(a, b, scale=1.0):
    return [x + scale * y for x, y in zip(a, b)]


def cross(a, b):
    return [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]


def length(a):
    return math.sqrt(sum(x * x for x in a))


class Patch:
    """A parallelogram in cells, seen from where `across` x `up` points. Cells in `holes` are left out."""

    def __init__(self, origin, across, up, cells=(1, 1), holes=()):
        self.origin, self.across, self.up, self.cells, self.holes = origin, across, up, cells, set(holes)
        self.width, self.height = length(across), length(up)

    def build(self, mesh, left, bottom, scale):
        normal = cross(self.across, self.up)
        normal = [x / length(normal) for x in normal]

        def corner(i, j):
            s, t = i / self.cells[0], j / self.cells[1]
            uv = (left + s * self.width * scale, bottom + t * self.height * scale)
            return add(add(self.origin, self.across, s), self.up, t), uv, normal

        for j in range(self.cells[1]):
            for i in range(self.cells[0]):
                if (i, j) not in self.holes:
                    mesh.add([corner(i, j), corner(i + 1, j), corner(i + 1, j + 1), corner(i, j + 1)])


def place(patches, scale):
    """Corners of the patches on shelves, or None if they do not fit [0,1]."""
    places, left, bottom, shelf = {}, GAP, GAP, 0
    for patch in sorted(patches, key=lambda p: (-p.height, -p.width)):
        width, height = patch.width * scale, patch.height * scale
        if left + width + GAP > 1:
            left, bottom, shelf = GAP, bottom + shelf + GAP, 0
        if left + width + GAP > 1 or bottom + height + GAP > 1:
            return None
        places[id(patch)] = left, bottom
        left, shelf = left + width + GAP, max(shelf, height)
    return places


def pack(patches):
    """A mesh of the patches, as large in the atlas as fits, all at one scale."""
    low, high = 0.0, 1.0 / max(max(p.width, p.height) for p in patches)
    for _ in range(40):
        middle = (low + high) / 2
        low, high = (middle, high) if place(patches, middle) else (low, middle)
    places, mesh = place(patches, low), Mesh()
    for patch in patches:
        patch.build(mesh, *places[id(patch)], low)
    return mesh


def read_spot():
    positions, uvs, faces = [], [], []
    with open(SPOT) as file:
        for words in map(str.split, file):
            if words and words[0] in ("v", "vt"):
                (positions if words[0] == "v" else uvs).append([float(x) for x in words[1:]])
            elif words and words[0] == "f":
                faces.append([[int(x) - 1 for x in word.split("/")[:2]] for word in words[1:]])
    return positions, uvs, faces


def ground():
    """Spot on its feet: the left half of the atlas is its own, the right half the ground's."""
    positions, uvs, faces = read_spot()
    low = [min(uv[i] for uv in uvs) for i in (0, 1)]
    high = [max(uv[i] for uv in uvs) for i in (0, 1)]
    scale = [(0.5 - 2 * GAP) / (high[0] - low[0]), (1 - 2 * GAP) / (high[1] - low[1])]
    mesh = Mesh()
    for face in faces:
        mesh.add([(positions[p], [GAP + (uvs[t][i] - low[i]) * scale[i] for i in (0, 1)], None) for p, t in face])
    y = min(p[1] for p in positions)
    side, cells = 4, 16
    middle = [(min(p[i] for p in positions) + max(p[i] for p in positions)) / 2 for i in (0, 2)]
    corner = [middle[0] - side / 2, y, middle[1] + side / 2]
    floor = Mesh()
    Patch(corner, [side, 0, 0], [0, 0, -side], (cells, cells)).build(floor, 0, 0, 1 / side)
    for face in floor.faces:
        mesh.add([(p, (0.5 + GAP + u * (0.5 - 2 * GAP), GAP + v * (1 - 2 * GAP)), n) for p, (u, v), n in face])
    return mesh


def box(low, high):
    """Four walls and a roof."""
    x, y, z = (b - a for a, b in zip(low, high))
    return [Patch([low[0], low[1], high[2]], [x, 0, 0], [0, y, 0]),
            Patch([high[0], low[1], low[2]], [-x, 0, 0], [0, y, 0]),
            Patch([high[0], low[1], high[2]], [0, 0, -z], [0, y, 0]),
            Patch([low[0], low[1], low[2]], [0, 0, z], [0, y, 0]),
            Patch([low[0], high[1], high[2]], [x, 0, 0], [0, 0, -z])]


def city():
    """Boxes on whole cells of a ground, none touching another; the ground under them is left out."""
    chance, cells, wanted = random.Random(2), 36, 40
    taken, boxes = set(), []
    while len(boxes) < wanted:
        wide, deep = chance.randint(2, 4), chance.randint(2, 4)
        i, j = chance.randint(1, cells - 1 - wide), chance.randint(1, cells - 1 - deep)
        if any((a, b) in taken for a in range(i - 1, i + wide + 1) for b in range(j - 1, j + deep + 1)):
            continue
        taken.update((a, b) for a in range(i, i + wide) for b in range(j, j + deep))
        height = 1.5 + 7 * chance.random() ** 1.5
        boxes.append(((i, 0, -j - deep), (i + wide, height, -j)))
    patches = [Patch([0, 0, 0], [cells, 0, 0], [0, 0, -cells], (cells, cells), taken)]
    for low, high in boxes:
        patches += box(low, high)
    return pack(patches)


def terrain():
    """Ridged noise of six octaves, twice as steep as hills are, smooth."""
    chance, cells = random.Random(4), 128
    slopes = [[(math.cos(a), math.sin(a)) for a in (chance.uniform(0, 2 * math.pi) for _ in range(256))]
              for _ in range(6)]

    def noise(octave, x, y):
        i, j = math.floor(x), math.floor(y)
        u, v = x - i, y - j

        def dot(a, b):
            gx, gy = slopes[octave][(i + a + 57 * (j + b)) % 256]
            return gx * (u - a) + gy * (v - b)

        s, t = (w * w * w * (w * (6 * w - 15) + 10) for w in (u, v))
        return (dot(0, 0) * (1 - s) + dot(1, 0) * s) * (1 - t) + (dot(0, 1) * (1 - s) + dot(1, 1) * s) * t

    def height(x, z):
        return sum(0.55 ** o * (0.6 - abs(noise(o, 2.1 ** o * 3 * x + 0.37, 2.1 ** o * 3 * z + 0.71)))
                   for o in range(6)) * 0.45

    mesh = Mesh()
    points = [[([i / cells, height(i / cells, j / cells), -j / cells],
                (0.005 + 0.99 * i / cells, 0.005 + 0.99 * j / cells), None) for i in range(cells + 1)]
              for j in range(cells + 1)]
    for j in range(cells):
        for i in range(cells):
            mesh.add([points[j][i], points[j][i + 1], points[j + 1][i + 1], points[j + 1][i]])
    return mesh


def well_stairs():
    """In one ground a square shaft, three times as deep as wide, and a flight of stairs down between two walls."""
    wide, deep, well, depth = 32, 16, (4, 8, 6, 10), 12  # cells of 1/4: the well from (4, 6) to (8, 10)
    steps, first, rise = 8, 12, 1.25  # stairs of two cells each from cell 12 on
    holes = {(i, j) for i in range(well[0], well[1]) for j in range(well[2], well[3])}
    holes |= {(i, j) for i in range(first, first + 2 * steps) for j in range(6, 10)}
    patches = [Patch([0, 0, 0], [wide, 0, 0], [0, 0, -deep], (wide, deep), holes)]
    x0, x1, z0, z1 = well[0], well[1], -well[2], -well[3]
    side, count = x1 - x0, (4, 12)
    patches += [Patch([x0, -depth, z1], [side, 0, 0], [0, depth, 0], count),
                Patch([x1, -depth, z0], [-side, 0, 0], [0, depth, 0], count),
                Patch([x0, -depth, z0], [0, 0, z1 - z0], [0, depth, 0], count),
                Patch([x1, -depth, z1], [0, 0, z0 - z1], [0, depth, 0], count),
                Patch([x0, -depth, z0], [side, 0, 0], [0, 0, z1 - z0], (4, 4))]
    for step in range(steps):
        x, y = first + 2 * step, -rise * (step + 1)
        patches += [Patch([x, y, z0], [2, 0, 0], [0, 0, z1 - z0], (2, 4)),
                    Patch([x, y, z0], [0, 0, z1 - z0], [0, rise, 0], (4, 1)),
                    Patch([x, y, z1], [2, 0, 0], [0, -y, 0], (2, 4)),
                    Patch([x + 2, y, z0], [-2, 0, 0], [0, -y, 0], (2, 4))]
    x, y = first + 2 * steps, -rise * steps
    patches.append(Patch([x, y, z1], [0, 0, z0 - z1], [0, -y, 0], (4, 8)))
    return pack(patches)


def leaves():
    """A crown of leaves above a ground, each of two faces a hair apart."""
    chance, hair = random.Random(6), 1e-3
    patches = [Patch([-3, 0, 3], [6, 0, 0], [0, 0, -6], (16, 16))]
    while len(patches) < 801:
        middle = [chance.uniform(-1, 1) for _ in range(3)]
        if length(middle) > 1:
            continue
        tilt, turn, spin = chance.uniform(0, 1.1), chance.uniform(0, 2 * math.pi), chance.uniform(0, 2 * math.pi)
        normal = [math.sin(tilt) * math.cos(turn), math.cos(tilt), math.sin(tilt) * math.sin(turn)]
        side = cross(normal, [math.cos(spin), 0.1, math.sin(spin)])
        side = [0.24 * x / length(side) for x in side]
        along = cross(normal, side)
        corner = add(add([1.5 * middle[0], 2 + 1.2 * middle[1], 1.5 * middle[2]], side, -0.5), along, -0.5)
        patches += [Patch(add(corner, along), side, [-x for x in along]),  # seen from below
                    Patch(add(corner, normal, hair), side, along)]
    return pack(patches)


def main():
    answer_help(__doc__)
    if len(sys.argv) != 2 or sys.argv[1].startswith("-"):
        sys.exit("usage: bench/scenes.py OUT_FOLDER")
    os.makedirs(sys.argv[1], exist_ok=True)
    shutil.copyfile(SPOT, os.path.join(sys.argv[1], "object.obj"))
    for scene in (ground, city, terrain, well_stairs, leaves):
        scene().write(os.path.join(sys.argv[1], scene.__name__ + ".obj"))


if __name__ == "__main__":
    main()
