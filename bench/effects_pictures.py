#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""The picture of docs/effects.md: above, scenes without an effect that they call for; below, with it.

    bench/effects_pictures.py BIN_FOLDER OUT.png

Each column is one effect: bakes with and without it, then vmframes at the same light and exposure. Needs oiiotool.
"""
import math
import os
import subprocess
import sys
import tempfile

from help_flag import answer_help
import leaf_cards
import png
import scenes

HERE = os.path.dirname(os.path.abspath(__file__))
DATA = os.path.join(HERE, "../tests/data")
CONFIG = os.path.join(HERE, "../configs/ocio/config.ocio")
STUDIO, SUNNY = os.path.join(DATA, "studio_small_03.hdr"), os.path.join(DATA, "kloppenheim_05.hdr")
GAZEBO, SPOT = os.path.join(DATA, "gazebo.obj"), os.path.join(DATA, "spot.obj")
SIDE = 240


def wall(path):
    """A wall behind spot, and one to its left."""
    mesh = scenes.Mesh()
    for patch in (scenes.Patch([-2, -1, -1.2], [4, 0, 0], [0, 3, 0]), scenes.Patch([-0.9, -1, 2], [0, 0, -4], [0, 3, 0])):
        patch.build(mesh, 0, 0, 0.1)
    mesh.write(path)


def painted(path):
    """The gazebo in one colour."""
    stem = os.path.splitext(path)[0]
    with open(stem + ".mtl", "w", encoding="utf-8") as file:
        file.write("newmtl paint\nKd 0.9 0.35 0.2\n")
    with open(path, "w", encoding="utf-8") as file, open(GAZEBO, encoding="utf-8") as plain:
        file.write(f"mtllib {os.path.basename(stem)}.mtl\nusemtl paint\n" + plain.read())


def bumps(path):
    """A normal map of a bumpy hide, in tangent space."""
    def pixel(x, y):
        across, down = (2 * math.pi * 24 * i / 512 for i in (x, y))
        slope = [0.55 * math.cos(across) * math.sin(down), -0.55 * math.sin(across) * math.cos(down), 1]
        length = scenes.length(slope)
        return [round(127.5 + 127.5 * s / length) for s in slope]

    with open(path, "wb") as file:
        file.write(png.encode([[pixel(x, y) for x in range(512)] for y in range(512)]))


def columns(folder):
    """For each effect: the words of vmframes for both, without it, with it."""
    def made(name):
        return os.path.join(folder, name)

    scenes.well_stairs().write(made("well_stairs.obj"))
    wall(made("wall.obj"))
    bumps(made("bumps.png"))
    painted(made("painted.obj"))
    subprocess.run([sys.executable, leaf_cards.__file__, folder], check=True)
    leaves = [made("leaf_cards.gltf"), STUDIO, "--uv-set", "1", "--white", "--elevation", "15", "--exposure", "-1.5"]
    return {
        "self-occlusion": ([GAZEBO, STUDIO, "--exposure", "-1.5"], ["--effects", "-self-occlusion"], []),
        "occluders": ([SPOT, STUDIO, "--azimuth", "30", "--exposure", "-1.5"], [], ["--occluder", made("wall.obj")]),
        "ground": ([SPOT, SUNNY, "--elevation", "-5", "--white"], [], ["--bake-ground"]),
        "cut-outs": (leaves, ["--cutouts", "off"], []),
        "normal-map": ([SPOT, STUDIO, "--white", "--exposure", "-1.5"], [], ["--normal-map", made("bumps.png")]),
        "max-distance": ([made("well_stairs.obj"), STUDIO, "--elevation", "75", "--exposure", "-1"], [], ["--max-distance", "0.3"]),
        "suns": ([GAZEBO, SUNNY, "--elevation", "20", "--model", "lobe"], [], ["--suns", "auto"]),
        "bounce": ([made("painted.obj"), STUDIO, "--elevation", "-10", "--exposure", "-0.5"], [], ["--bounce", "auto"]),
    }


TO_MAP = ("--effects", "--occluder", "--bake-ground", "--normal-map", "--max-distance")
TO_BOTH = ("--uv-set", "--cutouts")
SWITCHES = ("--white", "--bake-ground")


def sorted_words(words):
    """The flags of makevismap and of vmframes."""
    bake, frame, i = [], [], 0
    while i < len(words):
        flag, step = words[i], 1 if words[i] in SWITCHES else 2
        part = ["--ground"] if flag == "--bake-ground" else words[i:i + step]
        bake += part if flag in TO_MAP + TO_BOTH else []
        frame += part if flag not in TO_MAP else []
        i += step
    return bake, frame


def picture(binaries, folder, words, name):
    def run(tool, *rest):
        subprocess.run([os.path.join(binaries, tool), *rest, "--quiet"], check=True, stderr=subprocess.DEVNULL)

    def made(kind):
        return os.path.join(folder, f"{name}{kind}.exr")

    mesh, environment = words[:2]
    bake, frame = sorted_words(words[2:])
    run("makevismap", mesh, "--resolution", "512", "-o", made("_vismap"), *bake)
    run("vmframes", mesh, environment, "--vismap", made("_vismap"), "--size", str(SIDE), "--background", "0.18,0.18,0.18",
        "--colorconfig", CONFIG, "-o", made(""), *frame)
    return made("")


def main():
    answer_help(__doc__)
    if len(sys.argv) != 3:
        sys.exit("usage: bench/effects_pictures.py BIN_FOLDER OUT.png")
    with tempfile.TemporaryDirectory() as folder:
        above, below = [], []
        for name, (words, without, with_it) in columns(folder).items():
            for row, extra, suffix in ((above, without, "without"), (below, with_it, "with")):
                row.append(picture(sys.argv[1], folder, words + extra, f"{name}_{suffix}"))
        subprocess.run(["oiiotool", "--colorconfig", CONFIG, "--nosoftwareattrib"] + above + below
                       + ["--mosaic:pad=4", f"{len(above)}x2", "--ociodisplay:from=ACEScg", "sRGB - Display",
                          "ACES 1.0 - SDR Video", "--ch", "R,G,B", "-d", "uint8", "-o", sys.argv[2]], check=True)


if __name__ == "__main__":
    main()
