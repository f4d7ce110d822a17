#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""What each effect takes, as a ratio to the same stage without it:

    bench/effects.py BIN_FOLDER MESH ENVIRONMENT [rounds]

Whole processes, processor time of all threads. With and without take turns; the median ratio of the rounds is printed, and
the least and greatest. MESH, an OBJ, is the plain bake's, 1024x1024 at 64 rays; cut-outs have leaf_cards.py. Rows marked *
switch effects, which the process says the error of: they have the seconds of the bake alone, as it prints them. Of poses,
marked **, the upper quarter of MESH leans over in four frames: the seconds are those of one frame after the first, with its
files, as --explain prints them; baked whole, and keeping what it can. The last row bakes MESH with all effects forced that it
has (--effects all): what deciding saves.
"""
import os
import re
import statistics
import subprocess
import sys
import tempfile

import effects_pictures
from help_flag import answer_help
import leaf_cards

FRAMES = 4
BAKE = ["--resolution", "1024", "--samples", "64"]


def rows(folder, mesh, environment):
    """Name, words without, words with."""
    def made(name):
        return os.path.join(folder, name)

    bake = ["makevismap", mesh, *BAKE, "-o", made("bake.exr")]
    leaves = ["makevismap", made("leaf_cards.gltf"), "--uv-set", "1", *BAKE, "-o", made("leaves.exr")]
    light = ["makelightmap", made("map.exr"), environment, "--model", "lobe", "-o", made("lit.exr")]
    on_mesh = ["--mesh", mesh]
    poses = ["makevismap", made("pose.#.obj"), "--frames", f"1-{FRAMES}", *BAKE, "--explain", "-o",
             made("pose.#.exr")]
    return [
        ("self-occlusion *", [*bake, "--effects", "-self-occlusion"], bake),
        ("occluders", bake, [*bake, "--occluder", made("wall.obj")]),
        ("ground", bake, [*bake, "--ground"]),
        ("cut-outs", [*leaves, "--cutouts", "off"], leaves),
        ("normal-map", bake, [*bake, "--normal-map", made("bumps.png")]),
        ("max-distance", bake, [*bake, "--max-distance", "0.2"]),
        ("margin", [*bake, "--margin", "0"], bake),
        ("half", bake, [*bake, "--format", "half"]),
        ("color-conversion", light, [*light, "--output-colorspace", "ACES2065-1"]),
        ("filter", [*light[:2], made("light.exr"), *light[3:]], light),
        ("rotation", light, [*light, "--rotate", "0,30,0"]),
        ("albedo", light, [*light, "--albedo", made("albedo.exr")]),
        ("suns", light, [*light, "--suns", "auto", *on_mesh]),
        ("bounce", [*light, "--albedo", made("albedo.exr")],
         [*light, "--albedo", made("albedo.exr"), "--bounce", "auto", *on_mesh]),
        ("poses **", [*poses, "--effects", "+poses"], poses),
        ("all forced *", bake, [*bake, "--effects", "all"]),
    ]


def lean(mesh, folder):
    """Poses of a mesh whose upper quarter leans over, each frame by 2 % of its height more, without normals of its own."""
    with open(mesh, encoding="utf-8") as file:
        lines = [re.sub(r"(/\d*)/-?\d+", r"\1", line) if line.startswith("f ") else line
                 for line in file.read().splitlines() if not line.startswith("vn ")]
    heights = [float(line.split()[2]) for line in lines if line.startswith("v ")]
    top, height = max(heights), max(heights) - min(heights)
    for frame in range(FRAMES):
        with open(os.path.join(folder, f"pose.{frame + 1}.obj"), "w", encoding="utf-8") as file:
            for line in lines:
                if line.startswith("v "):
                    x, y, z = (float(word) for word in line.split()[1:4])
                    up = max(0, 1 - (top - y) / (0.25 * height))
                    line = f"v {x + 0.02 * frame * height * up * up:.7g} {y:.7g} {z:.7g}"
                file.write(line + "\n")


def printed(binaries, words):
    return subprocess.run([os.path.join(binaries, words[0]), *words[1:]], check=True, capture_output=True, text=True).stdout


def bake_seconds(binaries, words):
    """Of the bakes alone, as the process says."""
    return sum(float(found) for found in re.findall(r"bake: .* rays in ([0-9.]+) s", printed(binaries, words)))


def frame_seconds(binaries, words):
    """Of a frame after the first, as the process says."""
    frames = [float(found) for found in re.findall(r"^  frame \d+: ([0-9.]+) s; ", printed(binaries, words), re.MULTILINE)]
    return statistics.mean(frames[1:])


def seconds(binaries, words):
    """Processor time of the process."""
    child = subprocess.Popen([os.path.join(binaries, words[0]), *words[1:], "--quiet"],
                             stderr=subprocess.DEVNULL)
    _, status, usage = os.wait4(child.pid, 0)
    if status:
        sys.exit(f"failed; run it to see why: {' '.join(words)}")
    return usage.ru_utime + usage.ru_stime


def main():
    answer_help(__doc__)
    if not 4 <= len(sys.argv) <= 5:
        sys.exit("usage: bench/effects.py BIN_FOLDER MESH ENVIRONMENT [rounds]")
    binaries, mesh, environment = (os.path.abspath(word) for word in sys.argv[1:4])
    rounds = int(sys.argv[4]) if len(sys.argv) > 4 else 5
    with tempfile.TemporaryDirectory() as folder:
        effects_pictures.wall(os.path.join(folder, "wall.obj"))
        effects_pictures.bumps(os.path.join(folder, "bumps.png"))
        subprocess.run([sys.executable, leaf_cards.__file__, folder], check=True)
        subprocess.run(["oiiotool", "--pattern", "checker", "1024x1024", "3", "-d", "float", "--attrib", "oiio:ColorSpace",
                        "ACEScg", "-o", os.path.join(folder, "albedo.exr")], check=True)
        seconds(binaries, ["makevismap", mesh, *BAKE, "-o", os.path.join(folder, "map.exr")])
        seconds(binaries, ["makecfem", environment, "--stack", "-o", os.path.join(folder, "light.exr")])
        lean(mesh, folder)
        print(f"{'effect':16} {'ratio':>6} {'least':>6} {'most':>6}   seconds without, with")
        for name, without, with_it in rows(folder, mesh, environment):
            measure = {"*": bake_seconds, "**": frame_seconds}.get(name.split()[-1], seconds)
            pairs = [(measure(binaries, without), measure(binaries, with_it)) for _ in range(rounds)]
            ratios = sorted(b / a for a, b in pairs)
            print(f"{name:16} {statistics.median(ratios):6.3f} {ratios[0]:6.3f} {ratios[-1]:6.3f}   "
                  f"{statistics.median(a for a, _ in pairs):.2f}, {statistics.median(b for _, b in pairs):.2f}", flush=True)


if __name__ == "__main__":
    main()
