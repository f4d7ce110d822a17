#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Time of a bake of a head of hair: wavy strands in clumps on a ball, which fall past it.

    bench/groom.py [STRANDS] [POINTS] [RAYS] [KEEP]     (executables in $VMLIGHT_BIN or build/release/bin)

Writes a TressFX file of so many strands (50,000) of so many points (28), .1 mm thick at the root and .05 mm at the tip on
a head of .1 m, and bakes it with so many rays (64), beside the head: seconds by the clock, and of all threads. With KEEP,
a folder, the files stay there.
"""
import array
import math
import os
import random
import resource
import struct
import subprocess
import sys
import tempfile
import time

from help_flag import answer_help

HERE = os.path.dirname(os.path.abspath(__file__))
BIN = os.environ.get("VMLIGHT_BIN", os.path.join(HERE, "../build/release/bin"))
HEAD = 0.1  # metres
RADIUS = "0.00005:0.000025"
GOLDEN = math.pi * (3 - math.sqrt(5))


def normalised(v):
    length = math.sqrt(sum(x * x for x in v))
    return [x / length for x in v]


def root(share, turn):
    """On the scalp: the ball without the face and the neck."""
    y = 1 - share * 1.15
    ring = math.sqrt(1 - y * y)
    return [ring * math.cos(turn), y, ring * math.sin(turn)]


def strand(scalp, points, phase, rng):
    length = rng.uniform(0.18, 0.25)
    step = length / (points - 1)
    position, direction = [HEAD * x for x in scalp], scalp
    line = [position]
    for k in range(1, points):
        wave = 0.35 * min(1, k / 6)
        bend = [wave * math.sin(0.9 * k + phase), -0.25, wave * math.cos(0.9 * k + phase)]
        direction = normalised([d + b + rng.gauss(0, 0.02) for d, b in zip(direction, bend)])
        position = [p + step * d for p, d in zip(position, direction)]
        distance = math.sqrt(sum(x * x for x in position))
        if distance < HEAD * 1.005:
            position = [x * HEAD * 1.005 / distance for x in position]
        line.append(position)
    return line


def write_tfx(path, strands, points):
    rng = random.Random(1)
    clumps = max(1, strands // 40)
    phases = [rng.uniform(0, 2 * math.pi) for _ in range(clumps)]
    numbers = array.array("f")
    for i in range(strands):
        clump = i * clumps // strands
        # The roots of a clump are spread around its own.
        spread = 0.9 / math.sqrt(clumps)
        share = min(1, max(0, (clump + 0.5) / clumps + rng.gauss(0, spread / 12)))
        scalp = root(share, GOLDEN * clump + rng.gauss(0, spread))
        for position in strand(scalp, points, phases[clump] + rng.gauss(0, 0.3), rng):
            numbers.extend((*position, 1))
    with open(path, "wb") as file:
        file.write(struct.pack("<f3I", 4, strands, points, 160).ljust(160, b"\0"))
        numbers.tofile(file)


def write_ball(path, rows=48):
    columns = 2 * rows
    with open(path, "w", encoding="ascii") as file:
        for j in range(rows + 1):
            for i in range(columns + 1):
                theta, phi = math.pi * j / rows, 2 * math.pi * i / columns
                file.write(f"v {HEAD * math.sin(theta) * math.cos(phi):.6f} {HEAD * math.cos(theta):.6f} "
                           f"{HEAD * math.sin(theta) * math.sin(phi):.6f}\nvt {i / columns:.6f} {1 - j / rows:.6f}\n")
        for j in range(rows):
            for i in range(columns):
                a = j * (columns + 1) + i + 1
                b = a + columns + 1
                if j + 1 < rows:
                    file.write(f"f {a}/{a} {b + 1}/{b + 1} {b}/{b}\n")
                if j:
                    file.write(f"f {a}/{a} {a + 1}/{a + 1} {b + 1}/{b + 1}\n")


def main():
    answer_help(__doc__)
    strands, points, rays = (int(text) for text in (sys.argv[1:4] + ["50000", "28", "64"][len(sys.argv[1:4]):]))
    with tempfile.TemporaryDirectory() as temporary:
        folder = sys.argv[4] if len(sys.argv) > 4 else temporary
        os.makedirs(folder, exist_ok=True)
        hair, head = os.path.join(folder, "groom.tfx"), os.path.join(folder, "head.obj")
        write_tfx(hair, strands, points)
        write_ball(head)
        start, before = time.monotonic(), resource.getrusage(resource.RUSAGE_CHILDREN)
        subprocess.run([os.path.join(BIN, "makevismap"), hair, "--radius", RADIUS, "--occluder", head, "--samples", str(rays),
                        "-o", os.path.join(folder, "groom_vismap.exr")], check=True)
        after = resource.getrusage(resource.RUSAGE_CHILDREN)
        print(f"{strands} strands of {points} points, {rays} rays a texel: {time.monotonic() - start:.1f} s; "
              f"{after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime:.1f} s of processor time")


if __name__ == "__main__":
    main()
