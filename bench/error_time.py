#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Error against time, with and without reconstruction: a figure and its numbers.

    bench/error_time.py OUT_FOLDER FIGURE.svg     (executables in $VMLIGHT_BIN or build/release/bin)

The RMS error of V against the processor time of whole makevismap processes, the mean over the six scenes of bench/scenes.py
of both, for 4 to 512 rays per texel. VMLIGHT_RESOLUTION (512), VMLIGHT_REFERENCE_SAMPLES (4096) and VMLIGHT_ROUNDS (3; the
least time counts) change what is measured. Prints a Markdown table. Maps are kept, but no times. Needs gnuplot.
"""
import math
import os
import subprocess
import sys

from help_flag import answer_help
import reconstruct
from time_to_error import processor_seconds

HERE = os.path.dirname(os.path.abspath(__file__))
COUNTS = [4, 8, 16, 32, 64, 128, 256, 512]
MODES = ["off", "auto"]
ROUNDS = int(os.environ.get("VMLIGHT_ROUNDS", "3"))


def timed(folder, mesh, count, mode):
    """Processor seconds of a bake, and its map."""
    name = os.path.splitext(os.path.basename(mesh))[0]
    out = os.path.join(folder, f"{name}.{count}.{mode}.exr")
    least = math.inf
    for _ in range(ROUNDS):
        if os.path.exists(out):
            os.remove(out)
        begin = processor_seconds()
        reconstruct.bake(mesh, out, str(count), "--reconstruct", mode)
        least = min(least, processor_seconds() - begin)
    return least, out


def plot(rows, path):
    data = "".join("$%s << END\n%sEND\n" % (mode, "".join(f"{seconds} {error}\n" for seconds, error in rows[mode]))
                   for mode in MODES)
    script = data + f"""set terminal svg size 720,440 font 'sans,13' background 'white'
set output '{path}'
set logscale xy
set autoscale xfixmin
set autoscale xfixmax
set offsets graph .05, graph .05, 0, 0
set yrange [.002:.2]
set xlabel 'processor seconds of makevismap, mean of six scenes'
set ylabel 'RMS error of V'
set grid lc rgb '#dddddd'
set key top right
plot $off using 1:2 with linespoints lw 2 pt 7 ps .6 lc rgb '#888888' title 'rays alone', \\
     $auto using 1:2 with linespoints lw 2 pt 7 ps .6 lc rgb '#c04000' title 'reconstructed'
"""
    subprocess.run(["gnuplot", "-"], input=script, text=True, check=True)


def main():
    answer_help(__doc__)
    if len(sys.argv) != 3:
        sys.exit("usage: bench/error_time.py OUT_FOLDER FIGURE.svg")
    folder, figure = sys.argv[1:]
    scenes = os.path.join(folder, "scenes")
    os.makedirs(folder, exist_ok=True)
    subprocess.run([sys.executable, os.path.join(HERE, "scenes.py"), scenes], check=True)
    meshes = [os.path.join(scenes, name + ".obj") for name in reconstruct.SCENES]
    truths = [reconstruct.bake(mesh, os.path.join(folder, f"{os.path.basename(mesh)}.truth.exr"), reconstruct.REFERENCE,
                               "--reconstruct", "off", "--seed", "77", "--channels", "coverage") for mesh in meshes]
    rows = {mode: [] for mode in MODES}
    print("| rays | seconds, rays alone | RMS error of V | seconds, reconstructed | RMS error of V |")
    print("|---|---|---|---|---|")
    for count in COUNTS:
        cells = []
        for mode in MODES:
            seconds, maps = zip(*(timed(folder, mesh, count, mode) for mesh in meshes))
            errors = [reconstruct.errors(truth, path)[0] for truth, path in zip(truths, maps)]
            point = sum(seconds) / len(seconds), sum(errors) / len(errors)
            rows[mode].append(point)
            cells += [f"{point[0]:.2f}", f"{point[1]:.4f}"]
        print(f"| {count} | " + " | ".join(cells) + " |", flush=True)
    plot(rows, figure)


if __name__ == "__main__":
    main()
