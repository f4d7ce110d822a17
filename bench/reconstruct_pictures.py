#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""The picture of docs/accuracy.md: V of a floor beside a wall and below a leaf, from 16 rays a texel without and with
reconstruction, and from 4096.

    bench/reconstruct_pictures.py BIN_FOLDER OUT.png

Needs oiiotool.
"""
import math
import os
import subprocess
import sys
import tempfile

from help_flag import answer_help

SIDE = 192
# name, flags
BAKES = (("plain", ["--samples", "16", "--reconstruct", "off"]), ("reconstructed", ["--samples", "16", "--reconstruct", "auto"]),
         ("truth", ["--samples", "4096", "--reconstruct", "off"]))


def write_obj(path, vertices, faces, uvs=()):
    with open(path, "w", encoding="utf-8") as file:
        for vertex in vertices:
            file.write("v {:g} {:g} {:g}\n".format(*vertex))
        for uv in uvs:
            file.write("vt {:g} {:g}\n".format(*uv))
        for face in faces:
            file.write("f " + " ".join(f"{i}/{i}" if uvs else f"{i}" for i in face) + "\n")


def leaf(height, steps=24):
    """The outline of a leaf of length 0.5 with its stem, bent along its rib, as a fan of quads."""
    vertices, faces = [], []
    for i in range(steps + 1):
        along = i / steps
        half = 0.012 if along < 0.15 else 0.012 + 0.13 * math.sin(math.pi * (along - 0.15) / 0.85) ** 0.8
        for side in (-1, 0, 1):
            vertices.append((0.62 + half * side + 0.1 * along, height + 0.1 * abs(half * side), 0.25 + 0.5 * along))
    for i in range(steps):
        for side in (0, 1):
            first = 3 * i + side + 1
            faces.append((first, first + 1, first + 4, first + 3))
    return vertices, faces


def main():
    answer_help(__doc__)
    if len(sys.argv) != 3:
        sys.exit("usage: bench/reconstruct_pictures.py BIN_FOLDER OUT.png")
    with tempfile.TemporaryDirectory() as folder:
        def made(name):
            return os.path.join(folder, name)

        write_obj(made("floor.obj"), [(0, 0, 0), (0, 0, 1), (1, 0, 1), (1, 0, 0)], [(1, 2, 3, 4)],
                  [(0, 1), (0, 0), (1, 0), (1, 1)])
        write_obj(made("wall.obj"), [(0.2, 0, -1), (0.2, 0, 2), (0.2, 2, 2), (0.2, 2, -1)], [(1, 2, 3, 4)])
        write_obj(made("leaf.obj"), *leaf(0.035))
        maps = []
        for name, flags in BAKES:
            maps.append(made(name + ".exr"))
            subprocess.run([os.path.join(sys.argv[1], "makevismap"), made("floor.obj"), "--occluder", made("wall.obj"),
                            "--occluder", made("leaf.obj"), "--resolution", str(SIDE), "--quiet", "-o", maps[-1], *flags],
                           check=True)
        gray = [word for path in maps for word in (path, "--ch", "R=visibility,G=visibility,B=visibility")]
        subprocess.run(["oiiotool", "--nosoftwareattrib"] + gray + ["--mosaic:pad=4", f"{len(maps)}x1", "--resize:filter=box",
                        "200%", "-d", "uint8", "-o", sys.argv[2]], check=True)


if __name__ == "__main__":
    main()
