# SPDX-License-Identifier: Apache-2.0
"""How many rays does a visibility map need? Plots the error of the light against the rays per texel, for three shading
models, and that of visibility itself.

Run as: error_against_rays.py MESH ENVIRONMENT PICTURE.png [RESOLUTION [MOST_RAYS]]

The truth is traced by vmlight.make_reference(). Up to some count rays are what the light lacks; beyond it the curve of a
model is flat, and only a better model helps. Needs gnuplot for the picture; the numbers are printed too."""
import subprocess
import sys

import numpy as np

import vmlight

MODELS = "paper", "lobe", "sh"


def rms(values):
    return float(np.sqrt(np.mean(np.square(values, dtype=np.float64))))


def measure(mesh, environment, resolution, most_rays):
    """A row for each count of rays: the count, the error of each model as a share of the mean light, that of V."""
    truth = vmlight.make_reference(mesh, environment, resolution=resolution, samples=4096)
    covered = truth["coverage"] > 0
    light = truth.pixels[..., :3][covered]
    noise = rms(truth["error"][covered])  # of the truth itself, which is no fault of a model
    stack = vmlight.make_cfem(environment, stack=True)

    def bake(rays, **arguments):
        return vmlight.make_vismap(mesh, resolution=resolution, samples=rays, basis="sh", reconstruct="off", **arguments)

    exact = bake(16 * most_rays, seed=1)["visibility"][covered]
    rows = []
    rays = 4
    while rays <= most_rays:
        vismap = bake(rays)
        row = [rays]
        for model in MODELS:
            lit = vmlight.make_lightmap(vismap, stack, model=model).pixels[covered]
            row.append(np.sqrt(max(0, rms(lit - light) ** 2 - noise**2)) / light.mean())
        rows.append(row + [rms(vismap["visibility"][covered] - exact)])
        rays *= 2
    return rows


def plot(rows, picture):
    titles = [f"light by the model {model}" for model in MODELS] + ["visibility"]
    curves = ", ".join(f"'-' using 1:{i + 2} with linespoints linewidth 2 title '{title}'"
                       for i, title in enumerate(titles))
    data = "".join(" ".join(f"{value:.6g}" for value in row) + "\n" for row in rows) + "e\n"
    script = f"""set terminal pngcairo size 800,560
set output '{picture}'
set logscale xy
set xlabel 'rays per texel'
set ylabel 'RMS error: of light, relative to its mean; of visibility'
set grid
set key bottom left
set xtics 4
plot {curves}
"""
    subprocess.run(["gnuplot"], input=script + data * len(titles), text=True, check=True)


def main():
    mesh, environment, picture = sys.argv[1:4]
    resolution, most_rays = [int(number) for number in sys.argv[4:6] + ["256", "1024"][len(sys.argv[4:6]):]]
    rows = measure(mesh, environment, resolution, most_rays)
    print("rays", *MODELS, "visibility")
    for row in rows:
        print(row[0], *(f"{value:.4f}" for value in row[1:]))
    plot(rows, picture)


if __name__ == "__main__":
    main()
