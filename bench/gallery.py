#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""The picture of docs/large_scenes.md: a city block, a building, a landscape, and a groom on a body.

    bench/gallery.py ASSETS OUT.png     (executables in $VMLIGHT_BIN or build/release/bin)

ASSETS is a folder with meshes/delft_block_atlas_rd.obj, building/zdm2_atlas.obj, terrain/terrain_jacksboro.ply,
hair/ratboy_mohawk.tfx, hair/ratboy_body_atlas.obj, and skies in hdri/. Needs oiiotool. Takes minutes.
"""
import os
import subprocess
import sys
import tempfile

from help_flag import answer_help

HERE = os.path.dirname(os.path.abspath(__file__))
BIN = os.environ.get("VMLIGHT_BIN", os.path.join(HERE, "../build/release/bin"))
CONFIG = os.path.join(HERE, "../configs/ocio/config.ocio")
WIDTH, HEIGHT = 480, 360
BROWN = ["--strand-color", "0.25,0.12,0.05", "--strand-specular", "0.06", "--strand-exponent", "60"]


def pictures(assets):
    """Of each: the words of vmframes, and the part of the picture that is kept, as x, y, width over the whole's."""
    def asset(name):
        return os.path.join(assets, name)

    return [
        ([asset("meshes/delft_block_atlas_rd.obj"), asset("hdri/kloppenheim_05_1k.hdr"), "--up", "z", "--suns", "auto",
          "--resolution", "4096", "--elevation", "35", "--azimuth", "30"], (0.37, 0.52, 0.32)),
        ([asset("building/zdm2_atlas.obj"), asset("hdri/potsdamer_platz_1k.hdr"), "--resolution", "4096", "--elevation", "40",
          "--azimuth", "30"], (0.2, 0.18, 0.6)),
        ([asset("terrain/terrain_jacksboro.ply"), asset("hdri/pedestrian_overpass_1k.hdr"), "--suns", "auto", "--resolution",
          "2048", "--elevation", "30", "--azimuth", "30"], (0.22, 0.32, 0.4)),
        ([asset("hair/ratboy_body_atlas.obj"), asset("hdri/kloppenheim_05_1k.hdr"), "--object", asset("hair/ratboy_mohawk.tfx"),
          "--radius", "0.0012:0.0004", "--suns", "auto", "--elevation", "10", "--azimuth", "35", *BROWN], (0.28, 0.02, 0.48)),
    ]


def render(words, part, picture):
    x, y, width = part
    whole = [round(side / width) for side in (WIDTH, HEIGHT)]
    subprocess.run([os.path.join(BIN, "vmframes"), *words, "--size", "x".join(map(str, whole)), "--spp", "64", "--exposure",
                    "auto", "--background", "0.18,0.18,0.18", "--colorconfig", CONFIG, "--quiet", "-o", picture + "_whole.exr"],
                   check=True)
    cut = f"{WIDTH}x{HEIGHT}+{round(x * whole[0])}+{round(y * whole[1])}"
    subprocess.run(["oiiotool", picture + "_whole.exr", "--cut", cut, "-o", picture + ".exr"], check=True)
    return picture + ".exr"


def main():
    answer_help(__doc__)
    if len(sys.argv) != 3:
        sys.exit("usage: bench/gallery.py ASSETS OUT.png")
    with tempfile.TemporaryDirectory() as folder:
        cells = [render(words, part, os.path.join(folder, str(i)))
                 for i, (words, part) in enumerate(pictures(sys.argv[1]))]
        subprocess.run(["oiiotool", "--colorconfig", CONFIG, "--nosoftwareattrib", *cells, "--mosaic:pad=4", "2x2",
                        "--ociodisplay:from=ACEScg", "sRGB - Display", "ACES 1.0 - SDR Video", "--ch", "R,G,B", "-d", "uint8",
                        "-o", sys.argv[2]], check=True)


if __name__ == "__main__":
    main()
