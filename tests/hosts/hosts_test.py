# SPDX-License-Identifier: Apache-2.0
"""The stages in programs that know nothing of vmlight. A host that is not installed is skipped, and says so.

Run as: hosts_test.py [CASE ...], with VMLIGHT_BIN (the executables' folder) and VMLIGHT_SOURCE (the repository).
"""
import os
import re
import shutil
import subprocess
import sys
import tempfile
import unittest

BIN = os.environ["VMLIGHT_BIN"]
SOURCE = os.environ["VMLIGHT_SOURCE"]
SKY = os.path.join(SOURCE, "tests/data/studio_small_03.hdr")
SPOT = os.path.join(SOURCE, "tests/data/spot.obj")
CONFIG = os.path.join(SOURCE, "configs/ocio/config.ocio")

# A floor over the whole texture with a wall of half its width on one side: something to see in every part of the map.
SCENE = ("v -1 -1 0\nv 1 -1 0\nv 1 1 0\nv -1 1 0\nvt 0 0\nvt 1 0\nvt 1 1\nvt 0 1\nvn 0 0 1\nf 1/1/1 2/2/1 3/3/1 4/4/1\n")
WALL = "v -1 -1 0\nv -1 -1 1\nv -1 1 1\nv -1 1 0\nf 1 2 3 4\n"


class Host(unittest.TestCase):
    programs = []

    @classmethod
    def setUpClass(cls):
        for program in cls.programs:
            if not shutil.which(program):
                raise unittest.SkipTest(program + " is not installed")

    def setUp(self):
        self.folder = tempfile.mkdtemp(prefix="vmlight-host-")
        self.addCleanup(shutil.rmtree, self.folder)
        self.environment = {k: v for k, v in os.environ.items() if k != "OCIO"}
        with open(self.path("floor.obj"), "w") as out:
            out.write(SCENE)
        with open(self.path("wall.obj"), "w") as out:
            out.write(WALL)
        self.run_program(os.path.join(BIN, "makevismap"), "floor.obj", "--occluder", "wall.obj", "-o",
                         "floor_vismap.exr", "--resolution", "64", "--samples", "64", "--quiet")
        self.run_program(os.path.join(BIN, "makelightmap"), "floor_vismap.exr", SKY, "--rotate", "60,30,0", "-o",
                         "floor_lit.exr", "--quiet")

    def path(self, name):
        return os.path.join(self.folder, name)

    def run_program(self, *words):
        result = subprocess.run(words, capture_output=True, text=True, cwd=self.folder, env=self.environment,
                                timeout=300)
        self.assertEqual(result.returncode, 0, (words, result.stdout, result.stderr))
        return result.stdout

    def largest_difference(self, a, b):
        result = subprocess.run(["idiff", a, b], capture_output=True, text=True, cwd=self.folder)
        found = re.search(r"Max error\s*=\s*(\S+)", result.stdout)
        if not found:
            self.assertIn("PASS", result.stdout, result.stdout + result.stderr)
            return 0.0
        return float(found.group(1))


class Oiiotool(Host):
    programs = ["oiiotool", "idiff"]

    def test_a_lightmap_is_composed_like_any_picture(self):
        self.run_program("oiiotool", "floor_lit.exr", "--mulc", "0.5,0.25,1", "--resize", "32x32", "-o", "small.exr")
        # A lit picture with the visibility as its alpha, over a grey card.
        self.run_program("oiiotool", "floor_lit.exr", "floor_vismap.exr", "--ch", "visibility", "--chnames", "A",
                         "--chappend", "--dup", "--ch", "A,A,A,A", "--chnames", "R,G,B,A", "--mul", "--pattern",
                         "constant:color=0.1,0.1,0.1,1", "64x64", "4", "--over", "-o", "over.exr")
        out = self.run_program("oiiotool", "--info", "-v", "over.exr", "small.exr")
        self.assertIn("64 x   64, 4 channel", out)
        self.assertIn("32 x   32, 3 channel", out)

    def test_automatic_colour_conversion_leaves_a_visibility_map_alone(self):
        self.run_program("oiiotool", "--colorconfig", CONFIG, "--autocc", "floor_vismap.exr", "-o", "copy_vismap.exr")
        self.assertEqual(self.largest_difference("floor_vismap.exr", "copy_vismap.exr"), 0)

    def test_pixels_hold_no_nan(self):
        for name in "floor_vismap.exr", "floor_lit.exr":
            out = self.run_program("oiiotool", name, "--printstats")
            self.assertRegex(out, r"NanCount: (0 )+")
            self.assertRegex(out, r"InfCount: (0 )+")


class Maketx(Host):
    programs = ["maketx", "oiiotool", "idiff"]

    def test_mips_are_plain_averages_and_keep_their_channels(self):
        self.run_program("maketx", "floor_vismap.exr", "-o", "texture_vismap.exr", "--checknan")
        out = self.run_program("oiiotool", "--info", "-v", "texture_vismap.exr")
        for channel in "visibility", "direction.x", "direction.y", "direction.z":
            self.assertIn(channel, out)
        self.run_program("oiiotool", "texture_vismap.exr", "--selectmip", "1", "-o", "mip1.exr")
        self.run_program("oiiotool", "floor_vismap.exr", "--resize:filter=box", "32x32", "-o", "box.exr")
        self.assertLess(self.largest_difference("mip1.exr", "box.exr"), 1e-6)

    def test_lighting_a_mip_is_near_the_mip_of_the_light(self):
        # Not equal: the lookup direction is not linear in B. Measured here, at the worst texel: 0.021 at level 1 and
        # 0.016 at level 2, under a mean light of 0.22.
        self.run_program("maketx", "floor_vismap.exr", "-o", "texture_vismap.exr")
        self.run_program("maketx", "floor_lit.exr", "-o", "texture_lit.exr")
        for level, bound in ("1", 0.03), ("2", 0.03):
            self.run_program("oiiotool", "texture_vismap.exr", "--selectmip", level, "-o", "level_vismap.exr")
            self.run_program("oiiotool", "texture_lit.exr", "--selectmip", level, "-o", "level_lit.exr")
            self.run_program(os.path.join(BIN, "makelightmap"), "level_vismap.exr", SKY, "--rotate", "60,30,0", "-o",
                             "lit_level.exr", "--quiet")
            self.assertLess(self.largest_difference("level_lit.exr", "lit_level.exr"), bound, level)


class Python(Host):
    programs = ["oiiotool"]
    interpreter = "/usr/bin/python3"  # the one that Debian's module belongs to

    @classmethod
    def setUpClass(cls):
        super().setUpClass()
        found = subprocess.run([cls.interpreter, "-c", "import OpenImageIO, numpy"], capture_output=True)
        if found.returncode != 0:
            raise unittest.SkipTest("Python's modules OpenImageIO and numpy are not installed")

    def test_python_reads_both_maps(self):
        out = self.run_program(self.interpreter, os.path.join(SOURCE, "tests/hosts/python_host.py"),
                               "floor_vismap.exr", "floor_lit.exr").splitlines()
        self.assertRegex(out[0], r"^64 64 visibility,direction.x,direction.y,direction.z 0\.\d+ ")
        self.assertRegex(out[1], r"^64 64 R,G,B ")


class Blender(Host):
    programs = ["blender", "idiff"]

    def render(self, texture):
        out = self.run_program("blender", "--background", "--factory-startup", "--python-exit-code", "1", "--python",
                               os.path.join(SOURCE, "tests/hosts/blender_render.py"), "--", self.path("floor.obj"),
                               self.path(texture), "64", self.path("render.exr"))
        self.assertIn("rendered", out)
        self.run_program("oiiotool", "render.exr", "--ch", "R,G,B", "-o", "render_rgb.exr")
        return "render_rgb.exr"

    def test_cycles_shows_each_texel_where_it_belongs(self):
        self.assertLess(self.largest_difference("floor_lit.exr", self.render("floor_lit.exr")), 1e-6)


if __name__ == "__main__":
    unittest.main(argv=[sys.argv[0], *sys.argv[1:]], verbosity=1)
