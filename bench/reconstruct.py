#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""The error of V and B with and without --reconstruct, as a Markdown table:

    bench/reconstruct.py OUT_FOLDER [MESH ...]     (executables in $VMLIGHT_BIN or build/release/bin)
    bench/reconstruct.py --light OUT_FOLDER        the error of light at 16 rays per texel, in that at 4096

Of the six scenes of bench/scenes.py, and of meshes. VMLIGHT_RESOLUTION (512), VMLIGHT_SAMPLES ("16 64 256"),
VMLIGHT_REFERENCE_SAMPLES (4096) and VMLIGHT_THREADS (0, which is all) change what is baked. Each row has the RMS error of V
without, what it is divided by with reconstruction, and the same of its 99th percentile and its largest; then of B; and the
error that the reconstructed map says it has, in its true one. An interrupted run resumes where it stopped; delete the maps to measure another build.

--light prints for each scene and model the relative RMS error of light at 16 rays, and by how much it is above that at
4096, the mean over four skies: from vmcost's measurements of bench/ladder.py OUT_FOLDER, which it makes if they are not there.
"""
import os
import subprocess
import sys

import ladder

from help_flag import answer_help

HERE = os.path.dirname(os.path.abspath(__file__))
BIN = os.environ.get("VMLIGHT_BIN", os.path.join(HERE, "../build/release/bin"))
SCENES = ladder.SCENES
LIT_MODELS = ["paper", "lobe", "sh5"]
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


def print_light(folder):
    few, many = 16, 4096
    subprocess.run([sys.executable, os.path.join(HERE, "scenes.py"), os.path.join(folder, "scenes")], check=True)
    print("| scene | " + " | ".join(f"{model}, {few} rays | than with {many}" for model in LIT_MODELS) + " |")
    print("|---" * (2 * len(LIT_MODELS) + 1) + "|")
    all_of = {model: ([], []) for model in LIT_MODELS}

    def print_row(name, pairs):
        print(f"| {name} | " + " | ".join(f"{a:.4f} | {100 * (a / b - 1):+.1f} %" for a, b in pairs) + " |", flush=True)

    for scene in SCENES:
        lines = ladder.curves(ladder.measure(folder, scene, []))
        pairs = [(dict(lines[model])[few], dict(lines[model])[many]) for model in LIT_MODELS]
        for model, pair in zip(LIT_MODELS, pairs):
            for values, value in zip(all_of[model], pair):
                values.append(value)
        print_row(scene, pairs)
    print_row("**all**", [tuple(map(ladder.mean, all_of[model])) for model in LIT_MODELS])


def main():
    answer_help(__doc__)
    if len(sys.argv) == 3 and sys.argv[1] == "--light":
        return print_light(sys.argv[2])
    if len(sys.argv) < 2 or sys.argv[1].startswith("-"):
        sys.exit("usage: bench/reconstruct.py OUT_FOLDER [MESH ...] | --light OUT_FOLDER")
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
