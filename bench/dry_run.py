#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""What --dry-run expects of ten scenes of different kinds, and what they take:

    bench/dry_run.py BIN_FOLDER [rounds]

For each: seconds expected and taken, megabytes expected and taken at most, and expected / taken of both, the median of the
rounds. The promise is .75 to 1.25 on a machine that does nothing else; the processor time of the process is beside the time,
to see whether it was so.
"""
import os
import re
import statistics
import subprocess
import sys
import tempfile
import time

import effects_pictures
from help_flag import answer_help
import leaf_cards
import scenes

DATA = os.path.join(os.path.dirname(os.path.abspath(__file__)), "../tests/data")
EXPECTED = re.compile(r"expected: (?:at most )?([0-9.]+) s.*; ([0-9.]+) MB")


def ten_scenes(folder):
    """Name and command line, without -o."""
    def made(name):
        return os.path.join(folder, name)

    def data(name):
        return os.path.join(DATA, name)

    bake = ["--resolution", "1024", "--samples", "64"]
    light = [made("map.exr"), data("kloppenheim_05.hdr")]
    on_mesh = ["--mesh", data("spot.obj")]
    return [
        ("plain", ["makevismap", data("spot.obj"), *bake]),
        ("city", ["makevismap", made("city.obj"), *bake]),
        ("cut-outs", ["makevismap", made("leaf_cards.gltf"), "--uv-set", "1", *bake]),
        ("ground", ["makevismap", data("gazebo.obj"), *bake, "--ground", "--samples", "256"]),
        ("occluder", ["makevismap", data("spot.obj"), *bake, "--occluder", made("wall.obj")]),
        ("normal map", ["makevismap", data("spot.obj"), *bake, "--normal-map", made("bumps.png")]),
        ("light", ["makelightmap", *light]),
        ("suns", ["makelightmap", *light, "--suns", "auto", *on_mesh]),
        ("bounce", ["makelightmap", *light, "--bounce", "auto", "--albedo", made("albedo.exr"), *on_mesh]),
        ("animation", ["makelightmap", *light, "--frames", "1-24", "--rotate-y", "0:360"]),
    ]


def run(binaries, words):
    """Output, wall seconds, processor seconds and megabytes at most of the process."""
    with tempfile.TemporaryFile("w+") as out:
        begin = time.monotonic()
        child = subprocess.Popen([os.path.join(binaries, words[0]), *words[1:]], stdout=out, stderr=subprocess.STDOUT)
        _, status, usage = os.wait4(child.pid, 0)
        taken = time.monotonic() - begin
        out.seek(0)
        text = out.read()
    if status:
        sys.exit(f"failed: {' '.join(words)}\n{text}")
    return text, taken, usage.ru_utime + usage.ru_stime, usage.ru_maxrss / 1000


def main():
    answer_help(__doc__)
    if not 2 <= len(sys.argv) <= 3:
        sys.exit("usage: bench/dry_run.py BIN_FOLDER [rounds]")
    binaries = os.path.abspath(sys.argv[1])
    rounds = int(sys.argv[2]) if len(sys.argv) > 2 else 3
    with tempfile.TemporaryDirectory() as folder:
        for script in (scenes, leaf_cards):
            subprocess.run([sys.executable, script.__file__, folder], check=True)
        effects_pictures.wall(os.path.join(folder, "wall.obj"))
        effects_pictures.bumps(os.path.join(folder, "bumps.png"))
        subprocess.run(["oiiotool", "--pattern", "constant:color=.5,.4,.3", "1024x1024", "3", "-d", "float", "--attrib",
                        "oiio:ColorSpace", "ACEScg", "-o", os.path.join(folder, "albedo.exr")], check=True)
        run(binaries, ["makevismap", os.path.join(DATA, "spot.obj"), "--resolution", "1024", "--samples", "64", "-o",
                       os.path.join(folder, "map.exr")])
        print(f"{'scene':12} {'expected':>8} {'taken s':>8} {'CPU s':>6} {'ratio':>6}   {'expected':>8} {'taken MB':>8} "
              f"{'ratio':>6}")
        for name, words in ten_scenes(folder):
            frames = "####" if "--frames" in words else ""
            words = [*words, "-o", os.path.join(folder, f"out{frames}.exr")]
            seconds, taken, processor, bytes_, most = [], [], [], [], []
            for _ in range(rounds):
                text = run(binaries, [*words, "--dry-run"])[0]
                found = EXPECTED.search(text)
                if not found:
                    sys.exit(f"no forecast: {' '.join(words)}\n{text}")
                seconds.append(float(found.group(1)))
                bytes_.append(float(found.group(2)))
                _, wall, cpu, memory = run(binaries, words)
                taken.append(wall)
                processor.append(cpu)
                most.append(memory)
            time_ratio = statistics.median(a / b for a, b in zip(seconds, taken))
            memory_ratio = statistics.median(a / b for a, b in zip(bytes_, most))
            print(f"{name:12} {statistics.median(seconds):8.2f} {statistics.median(taken):8.2f} "
                  f"{statistics.median(processor):6.2f} {time_ratio:6.2f}   {statistics.median(bytes_):8.0f} "
                  f"{statistics.median(most):8.0f} {memory_ratio:6.2f}", flush=True)


if __name__ == "__main__":
    main()
