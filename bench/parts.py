#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""What baking a map in parts costs beside baking it whole, as a Markdown table:

    bench/parts.py OUT_FOLDER [MESH ...]        (executables in $VMLIGHT_BIN or build/release/bin)

Each mesh is baked whole, then in parts one after another, then joined, all in processor time. Efficiency is the time of the
whole over the sum of the parts'. The joined map is compared with the whole one. A number such as 10 instead of a mesh stands for a
wavy grid of so many million triangles (bench/large_mesh.py).

VMLIGHT_PARTS (16), VMLIGHT_RESOLUTION (4096), VMLIGHT_THREADS (2) and VMLIGHT_FLAGS ("", more flags of makevismap) change what is
measured.
"""
import filecmp
import glob
import math
import os
import resource
import subprocess
import sys

from help_flag import answer_help
import large_mesh

HERE = os.path.dirname(os.path.abspath(__file__))
BIN = os.path.abspath(os.environ.get("VMLIGHT_BIN", os.path.join(HERE, "../build/release/bin")))
PARTS = int(os.environ.get("VMLIGHT_PARTS", "16"))
RESOLUTION = os.environ.get("VMLIGHT_RESOLUTION", "4096")
THREADS = os.environ.get("VMLIGHT_THREADS", "2")
FLAGS = os.environ.get("VMLIGHT_FLAGS", "").split()


def processor_seconds():
    used = resource.getrusage(resource.RUSAGE_CHILDREN)
    return used.ru_utime + used.ru_stime


def makevismap(*words):
    """Processor seconds."""
    before = processor_seconds()
    subprocess.run([os.path.join(BIN, "makevismap"), *words, "--threads", THREADS, "--quiet"], check=True,
                   stderr=subprocess.DEVNULL)
    return processor_seconds() - before


def mesh_file(word, folder):
    if not word.isdigit():
        return word
    path = os.path.join(folder, f"grid{word}.ply")
    if not os.path.exists(path):
        large_mesh.write_ply(path, 1 + math.isqrt(int(word) * 500000))
    return path


def main():
    answer_help(__doc__)
    if len(sys.argv) < 3:
        sys.exit(__doc__)
    folder = sys.argv[1]
    os.makedirs(folder, exist_ok=True)
    print(f"| {PARTS} parts of {RESOLUTION}x{RESOLUTION} {' '.join(FLAGS)} | whole | sum of parts | slowest part | join | efficiency |")
    print("|---|---|---|---|---|---|")
    for word in sys.argv[2:]:
        mesh = mesh_file(word, folder)
        name = os.path.splitext(os.path.basename(mesh))[0]
        whole, joined, parted = (os.path.join(folder, f"{name}_{kind}.exr") for kind in ("whole", "joined", "parted"))
        flags = ["--resolution", RESOLUTION, *FLAGS]
        once = makevismap(mesh, "-o", whole, *flags)
        each = [makevismap(mesh, "-o", parted, *flags, "--part", f"{part}/{PARTS}") for part in range(1, PARTS + 1)]
        files = sorted(glob.glob(glob.escape(parted[:-len(".exr")]) + ".part*of*.exr"))
        join = makevismap("--join", *files, "-o", joined)
        same = "" if filecmp.cmp(whole, joined, shallow=False) else ", other bytes"
        for file in files + [whole, joined]:
            os.remove(file)
        print(f"| {name} | {once:.1f} s | {sum(each):.1f} s | {max(each):.1f} s | {join:.1f} s | {once / sum(each):.2f}{same} |", flush=True)


if __name__ == "__main__":
    main()
