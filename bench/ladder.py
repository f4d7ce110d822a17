#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""The error of each shading model on six scenes under four environments, as a Markdown table:

    bench/ladder.py OUT_FOLDER [FLAG_OF_VMCOST ...]      (executables in $VMLIGHT_BIN or build/release/bin)

Makes the scenes (bench/scenes.py), runs vmcost on each (an interrupted run resumes where it stopped) and prints the
relative RMS error of each model, the mean over the environments, at its knee: the number of rays (in brackets) beyond
which the model gains less than 2 %. Writes OUT_FOLDER/SCENE/report.html, and the plot of the first scene,
tests/data/spot.obj, to bench/.
"""
import json
import os
import shutil
import subprocess
import sys

from help_flag import answer_help

HERE = os.path.dirname(os.path.abspath(__file__))
DATA = os.path.join(HERE, "../tests/data")
BIN = os.environ.get("VMLIGHT_BIN", os.path.join(HERE, "../build/release/bin"))
SCENES = ["object", "ground", "city", "terrain", "well_stairs", "leaves"]
ENVIRONMENTS = ["studio_small_03.hdr", "kloppenheim_05.hdr", "forest_slope.hdr", "st_fagans_interior.hdr"]
DEFAULTS = {"cfem_width": (128, 0), "storage": ("float", ""), "divisor": (1,)}
KNEE_GAIN = 0.02  # as vmcost's


def measure(folder, scene, flags):
    out = os.path.join(folder, scene)
    subprocess.run([os.path.join(BIN, "vmcost"), os.path.join(folder, "scenes", scene + ".obj"),
                    *(os.path.join(DATA, name) for name in ENVIRONMENTS), "-o", out, *flags], check=True,
                   stdout=sys.stderr)
    with open(os.path.join(out, "costs.json")) as file:
        return json.load(file)["rows"]


def mean(values):
    values = list(values)
    return sum(values) / len(values)


def curves(rows):
    """{model: [(samples, mean error)]}, by samples."""
    found = {}
    for row in rows:
        if all(row[name] in allowed for name, allowed in DEFAULTS.items()):
            found.setdefault(row["model"], {}).setdefault(row["samples"], []).append(row["rmse"])
    return {model: [(samples, mean(errors)) for samples, errors in sorted(line.items())]
            for model, line in found.items()}


def knee(line):
    return next((samples, error) for i, (samples, error) in enumerate(line)
                if error * (1 - KNEE_GAIN) <= min(other for _, other in line[i:]))


def main():
    answer_help(__doc__)
    if len(sys.argv) < 2:
        sys.exit("usage: bench/ladder.py OUT_FOLDER [FLAG_OF_VMCOST ...]")
    folder, flags = sys.argv[1], sys.argv[2:]
    subprocess.run([sys.executable, os.path.join(HERE, "scenes.py"), os.path.join(folder, "scenes")], check=True)
    found = {scene: curves(measure(folder, scene, flags)) for scene in SCENES}
    models = [model for model in found[SCENES[0]] if model != "traced"]
    traced = next(iter(found.values())).get("traced", [])
    columns = [(model, lambda line: knee(line)) for model in models]
    if traced:
        most = traced[-1][0]
        columns.append((f"traced, {most} rays", lambda line: line[-1]))
    print("| scene | " + " | ".join(name for name, _ in columns) + " |")
    print("|---" * (len(columns) + 1) + "|")
    sums = {name: [] for name, _ in columns}
    for scene in SCENES:
        cells = []
        for name, pick in columns:
            samples, error = pick(found[scene][name.split(",")[0]])
            sums[name].append(error)
            cells.append(f"{error:.3f}" + ("" if name.startswith("traced") else f" ({samples})"))
        print(f"| {scene} | " + " | ".join(cells) + " |")
    print("| **all** | " + " | ".join(f"**{mean(values):.3f}**" for values in sums.values()) + " |")
    plot = os.path.join(folder, SCENES[0], "error_time.svg")
    if os.path.exists(plot):
        shutil.copyfile(plot, os.path.join(HERE, "what_accuracy_costs.svg"))


if __name__ == "__main__":
    main()
