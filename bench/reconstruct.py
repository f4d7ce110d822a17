#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""The error of V and B with and without --reconstruct, as a Markdown table:

    bench/reconstruct.py OUT_FOLDER [MESH ...]     (executables in $VMLIGHT_BIN or build/release/bin)

Of the six scenes of bench/scenes.py, and of meshes. VMLIGHT_RESOLUTION (512), VMLIGHT_SAMPLES ("16 64 256"),
VMLIGHT_REFERENCE_SAMPLES (4096) and VMLIGHT_THREADS (0, which is all) change what is baked. Each row has the RMS error of V
without, what it is divided by with reconstruction, and the same of its 99th percentile and its largest; then of B; and the
error that the reconstructed map says it has, in its true one. An interrupted run resumes where it stopped; delete the maps to measure another build.
"""
import os
import subprocess
import sys

import ladder
from help_flag import answer_help

HERE = os.path.dirname(os.path.abspath(__file__))
BIN = os.environ.get("VMLIGHT_BIN", os.path.join(HERE, "../build/release/bin"))
SCENES = ladder.SCENES
RESOLUTION = os.environ.get("VMLIGHT_RESOLUTION", "512")
SAMPLES = os.environ.get("VMLIGHT_SAMPLES", "16 64 256").split()
REFERENCE = os.environ.get("VMLIGHT_REFERENCE_SAMPLES", "4096")
THREADS = os.environ.get("VMLIGHT_THREADS", "0")


def bake(mesh, out, samples, *flags):
    if not os.path.exists(out):
        subprocess.run([os.path.join(BIN, "makevismap"), mesh, "-o", out, "--resolution", RESOLUTION, "--samples", samples,
                        "--threads", THREADS, "--quiet", *flags], check=True, stderr=subprocess.DEVNULL)
    return out


def errors(truth, path):
    """RMS, 99th percentile and largest error of V, the same of B, and the RMS of the channel error."""
    result = subprocess.run([os.path.join(BIN, "map_error"), truth, path], check=True, capture_output=True, text=True)
    return [float(word) for word in result.stdout.split()]


def main():
    answer_help(__doc__)
    if len(sys.argv) < 2 or sys.argv[1].startswith("-"):
        sys.exit("usage: bench/reconstruct.py OUT_FOLDER [MESH ...]")
    folder = sys.argv[1]
    scenes = os.path.join(folder, "scenes")
    subprocess.run([sys.executable, os.path.join(HERE, "scenes.py"), scenes], check=True)
    meshes = [os.path.join(scenes, name + ".obj") for name in SCENES] + sys.argv[2:]
    print("| scene | rays | V | RMS | 99 % | worst | B | RMS | 99 % | worst | said |")
    print("|---" * 11 + "|")
    for mesh in meshes:
        name = os.path.splitext(os.path.basename(mesh))[0]

        def path(kind):
            return os.path.join(folder, f"{name}.{RESOLUTION}.{kind}.exr")

        truth = bake(mesh, path("truth"), REFERENCE, "--reconstruct", "off", "--seed", "77", "--channels", "coverage")
        for samples in SAMPLES:
            plain = errors(truth, bake(mesh, path(f"{samples}.off"), samples, "--reconstruct", "off"))
            better = errors(truth, bake(mesh, path(f"{samples}.auto"), samples, "--reconstruct", "auto", "--channels",
                                        "error"))
            by = [a / b if b else 1 for a, b in zip(plain, better)]
            print(f"| {name} | {samples} | {plain[0]:.4f} | " + " | ".join(f"{x:.2f}" for x in by[:3])
                  + f" | {plain[3]:.4f} | " + " | ".join(f"{x:.2f}" for x in by[3:6])
                  + f" | {better[6] / better[0]:.2f} |", flush=True)


if __name__ == "__main__":
    main()
