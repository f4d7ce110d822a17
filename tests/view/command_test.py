#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""vmview's command line, without a display. Skipped (77) where EGL gives no OpenGL."""
import os
import subprocess
import sys
import tempfile
import unittest

try:
    import OpenImageIO
except ImportError:
    print("skipped: missing OpenImageIO for Python")
    sys.exit(77)

BIN = os.environ["VMLIGHT_BIN"]
DATA = os.path.join(os.environ["VMLIGHT_SOURCE"], "tests", "data")
MESH, SKY = DATA + "/cases/box.obj", DATA + "/studio_small_03.hdr"
CONFIG = os.path.join(os.environ["VMLIGHT_SOURCE"], "configs/ocio/config.ocio")
GROOM = ["--radius", "0.05"]
SMALL = ["--resolution", "32", "--samples", "4", "--size", "48x32", "--spp", "1"]


def run(folder, *arguments, **environment):
    variables = {key: value for key, value in os.environ.items() if key not in ("DISPLAY", "WAYLAND_DISPLAY", "OCIO")}
    variables.update(XDG_CONFIG_HOME=folder, **environment)
    return subprocess.run([BIN + "/vmview", *arguments], cwd=folder, env=variables, capture_output=True, text=True,
                          timeout=300)


class Command(unittest.TestCase):
    def setUp(self):
        self.folder = tempfile.TemporaryDirectory()
        self.addCleanup(self.folder.cleanup)

    def run_here(self, *arguments, **environment):
        return run(self.folder.name, *arguments, **environment)

    def assert_fails(self, code, words, *arguments):
        result = self.run_here(*arguments)
        self.assertEqual(result.returncode, code, result)
        self.assertIn(words, result.stderr)
        self.assertEqual(os.listdir(self.folder.name), [])

    def test_pictures(self):
        for name in ("a.exr", "a.png", "a.jpg"):
            result = self.run_here(MESH, SKY, *SMALL, "-o", name, "--quiet")
            self.assertEqual((result.returncode, result.stderr, result.stdout), (0, "", ""), name)
        # Without an environment what needs none; nothing but the pictures is left.
        result = self.run_here(MESH, *SMALL, "--show", "visibility", "--headless", "-o", "v.png", "--quiet")
        self.assertEqual((result.returncode, result.stderr), (0, ""))
        self.assertEqual(sorted(os.listdir(self.folder.name)), ["a.exr", "a.jpg", "a.png", "v.png"])

    def write_lines(self, name):
        path = os.path.join(self.folder.name, name)
        with open(path, "w") as file:
            file.write("v 0 0 0\nv 0 .5 .1\nv 0 1 .4\nv .5 0 0\nv .5 .5 .1\nv .6 1 .4\nl 1 2 3\nl 4 5 6\n")
        return path

    def test_strands(self):
        hair = self.write_lines("hair.obj")
        for index, scene in enumerate(([hair, SKY], [MESH, SKY, "--object", hair])):
            name = f"{index}.exr"
            flags = SMALL if MESH in scene else SMALL[2:]
            result = self.run_here(*scene, *GROOM, "--strand-color", "1,.5,.2", "--strand-texels", "4", *flags, "-o", name,
                                   "--quiet")
            self.assertEqual((result.returncode, result.stderr, result.stdout), (0, "", ""), scene)
        result = self.run_here(hair, SKY, *GROOM, "--samples", "4", "--size", "48x32", "--bench", "2", "--suns", "auto")
        self.assertRegex(result.stdout, r"bench: 2 frames of 48x32", result)

    def test_strand_flags_without_effect(self):
        hair = self.write_lines("hair.obj")
        os.rename(hair, self.folder.name + ".obj")
        hair = self.folder.name + ".obj"
        self.addCleanup(os.remove, hair)
        self.assert_fails(2, "--strand-texels 4: no object is strands", MESH, SKY, "--strand-texels", "4", "-o", "a.exr")
        self.assert_fails(2, "--strand-color 1,1,1: no object is strands", MESH, SKY, "--strand-color", "1,1,1", "-o", "a.exr")
        self.assert_fails(2, "--strand-color 1,1,1: --white shows all white", hair, SKY, *GROOM, "--white", "--strand-color",
                          "1,1,1", "-o", "a.exr")
        self.assert_fails(2, "--resolution 64: a map of strands does not use it", hair, SKY, *GROOM, "--resolution", "64",
                          "-o", "a.exr")
        self.assert_fails(2, "--strand-exponent 9: only --strand-specular uses it", hair, SKY, *GROOM, "--strand-exponent",
                          "9", "-o", "a.exr")
        self.assert_fails(2, "--strand-specular 1: no object is strands", MESH, SKY, "--strand-specular", "1", "-o", "a.exr")
        self.assert_fails(2, "--strand-exponent: 501 is not in [1, 500]", hair, SKY, *GROOM, "--strand-specular", "1",
                          "--strand-exponent", "501", "-o", "a.exr")
        self.assert_fails(1, "only they can be beside MESH", hair, SKY, *GROOM, "--object", MESH, "-o", "a.exr")

    def test_same_picture_twice(self):
        for name in ("a.exr", "b.exr"):
            self.run_here(MESH, SKY, *SMALL, "-o", name, "--quiet")
        with open(self.folder.name + "/a.exr", "rb") as a, open(self.folder.name + "/b.exr", "rb") as b:
            self.assertEqual(a.read(), b.read())

    def read(self, name):
        with open(os.path.join(self.folder.name, name), "rb") as file:
            return file.read()

    def test_flags_reach_the_picture(self):
        common = [MESH, SKY, "--size", "48x32", "--quiet"]
        pictures = {}
        for name, flags in {"baked": SMALL[:4], "model": SMALL[:4] + ["--model", "ao"],
                            "filter": SMALL[:4] + ["--filter", "box"], "samples": SMALL[:4] + ["--spp", "2"],
                            "atlas": SMALL[:4] + ["--unwrap"]}.items():
            result = self.run_here(*common, *flags, "-o", name + ".exr")
            self.assertEqual((result.returncode, result.stderr), (0, ""), name)
            pictures[name] = self.read(name + ".exr")
        self.assertEqual(len(set(pictures.values())), len(pictures))
        # A stored map gives the picture of the same bake.
        subprocess.run([BIN + "/makevismap", MESH, "-o", self.folder.name + "/vm.exr", *SMALL[:4], "--basis", "sh",
                        "--channels", "normal,coverage", "--quiet"], check=True)
        result = self.run_here(*common, "--vismap", "vm.exr", "-o", "stored.exr")
        self.assertEqual((result.returncode, result.stderr), (0, ""))
        self.assertEqual(self.read("stored.exr"), pictures["baked"])
        # Displays of a config.
        shown = set()
        for view in "Raw", "Un-tone-mapped":
            result = self.run_here(*common, *SMALL[:4], "--colorconfig", CONFIG, "--display", "P3-D65 - Display", "--view",
                                   view, "-o", "shown.png")
            self.assertEqual((result.returncode, result.stderr), (0, ""))
            shown.add(self.read("shown.png"))
        self.assertEqual(len(shown), 2)
        self.assert_ends(2, "--resolution 32: the visibility map is made already", *common, "--vismap", "vm.exr", *SMALL[:2])
        self.assert_ends(2, "only --background environment is blurred", *common, "--background-blur", "3")
        self.assert_ends(2, "an EXR holds scene-linear light", *common, "--view", "Raw")

    def test_numbers_are_as_they_are(self):
        """V of an open square is 1, without exposure or display; |B| / V is 2/3."""
        with open(self.folder.name + "/square.obj", "w") as file:
            file.write("v -1 -1 0\nv 1 -1 0\nv 1 1 0\nv -1 1 0\nvt 0 0\nvt 1 0\nvt 1 1\nvt 0 1\nvn 0 0 1\n"
                       "f 1/1/1 2/2/1 3/3/1 4/4/1\n")
        common = ["square.obj", SKY, "--resolution", "8", "--samples", "4", "--size", "8", "--elevation", "0"]
        for name in "ratio.exr", "ratio.png":
            result = self.run_here(*common, "--show", "ratio", "-o", name, "--quiet")
            self.assertEqual((result.returncode, result.stderr), (0, ""))
            image = OpenImageIO.ImageBuf(os.path.join(self.folder.name, name))
            self.assertAlmostEqual(image.getpixel(4, 4)[0], 2 / 3, delta=0.002, msg=name)
        image = OpenImageIO.ImageBuf(self.folder.name + "/ratio.exr")
        self.assertEqual(image.spec().get_string_attribute("colorInteropID"), "data")
        for exposure in "1", "auto":
            self.assert_ends(2, "--exposure: --show ratio has no light to expose", *common, "--show", "ratio", "--exposure",
                             exposure)
        result = self.run_here(*common, "--show", "ratio", "--view", "Raw", "-o", "x.png")
        self.assertEqual(result.returncode, 2)
        self.assertIn("--view Raw: --show ratio is not light, which a display would change", result.stderr)

    def test_what_is_lit_otherwise_is_said(self):
        subprocess.run([BIN + "/makevismap", DATA + "/gazebo.obj", "-o", self.folder.name + "/other.exr", "--resolution", "8",
                        "--samples", "1", "--quiet"], check=True, stderr=subprocess.DEVNULL)
        result = self.run_here(MESH, SKY, "--vismap", "other.exr", "--size", "8", "-o", "a.exr", "--quiet")
        self.assertEqual(result.returncode, 0)
        self.assertIn('vmview WARNING: "other.exr": was baked from another mesh than "', result.stderr)
        with open(self.folder.name + "/tiles.obj", "w") as file:
            file.write("v 0 0 0\nv 1 0 0\nv 0 1 0\nvt .1 .1\nvt .9 .1\nvt .1 .9\nvt 1.1 .1\nvt 1.9 .1\nvt 1.1 .9\n"
                       "vn 0 0 1\nf 1/1/1 2/2/1 3/3/1\nv 2 0 0\nv 3 0 0\nv 2 1 0\nf 4/4/1 5/5/1 6/6/1\n")
        result = self.run_here("tiles.obj", SKY, *SMALL, "-o", "a.exr", "--quiet")
        self.assertEqual(result.returncode, 0)
        self.assertIn('"tiles.obj": UVs in 2 UDIM tiles, 1001 to 1002, of which 1001 alone is lit; --udim chooses another',
                      result.stderr)

    def test_a_tile_is_chosen(self):
        """Two triangles side by side, each alone in its tile: one half of the picture has V = 1, the other nothing."""
        with open(self.folder.name + "/tiles.obj", "w") as file:
            file.write("v 0 0 0\nv 1 0 0\nv 0 1 0\nvt .1 .1\nvt .9 .1\nvt .1 .9\nvt 1.1 .1\nvt 1.9 .1\nvt 1.1 .9\n"
                       "vn 0 0 1\nf 1/1/1 2/2/1 3/3/1\nv 2 0 0\nv 3 0 0\nv 2 1 0\nf 4/4/1 5/5/1 6/6/1\n")
        subprocess.run([BIN + "/makevismap", "tiles.obj", "-o", "vm.<UDIM>.exr", *SMALL[:4], "--quiet"], check=True,
                       cwd=self.folder.name)
        for bake in SMALL[:4], ["--vismap", "vm.<UDIM>.exr"]:
            for udim, lit in ("1001", 0), ("1002", 1):
                result = self.run_here("tiles.obj", *bake, "--show", "visibility", "--elevation", "0", "--size", "48x24",
                                       "--udim", udim, "-o", udim + ".exr", "--quiet")
                self.assertEqual((result.returncode, result.stderr), (0, ""))
                values = OpenImageIO.ImageBuf(f"{self.folder.name}/{udim}.exr").get_pixels(OpenImageIO.FLOAT)[..., 0]
                halves = values[:, :24].max(), values[:, 24:].max()
                self.assertAlmostEqual(halves[lit], 1, delta=1e-5)
                self.assertEqual(halves[1 - lit], 0)
            os.remove(f"{self.folder.name}/{udim}.exr")

    def assert_ends(self, code, words, *arguments):
        result = self.run_here(*arguments, "-o", "x.exr")
        self.assertEqual(result.returncode, code, result)
        self.assertIn(words, result.stderr)

    def test_bench(self):
        result = self.run_here(MESH, SKY, *SMALL, "--bench", "3")
        self.assertEqual(result.returncode, 0, result)
        self.assertRegex(result.stdout, r"bench: 3 frames of 48x32: median [\d.]+ ms, p99 [\d.]+ ms; ")

    def test_wrong_usage(self):
        self.assert_fails(2, "MESH is missing; only a window opens without one", "-o", "a.exr")
        self.assert_fails(2, "ENVIRONMENT is missing", MESH, "-o", "a.exr")
        self.assert_fails(2, "--headless needs -o PICTURE, or --bench", MESH, SKY, "--headless")
        self.assert_fails(2, "--format half: only an EXR is stored so", MESH, SKY, "--headless", "-o", "a.png", "--format", "half")
        self.assert_fails(2, '"a.gif": the extension must be exr, png, jpg, webp or tif', MESH, SKY, "-o", "a.gif")
        self.assert_fails(2, "show", MESH, SKY, "-o", "a.exr", "--show", "nonsense")
        self.assert_fails(2, "unexpected argument", MESH, SKY, SKY, "-o", "a.exr")

    def test_failures(self):
        self.assert_fails(1, "nowhere.obj", "nowhere.obj", SKY, "-o", "a.exr")
        self.assert_fails(1, "nowhere.hdr", MESH, "nowhere.hdr", "-o", "a.exr")
        self.assert_fails(1, "makevismap --channels error", MESH, SKY, *SMALL, "--show", "error", "-o", "a.exr")
        self.assert_fails(1, "no window can be opened here", MESH, SKY)

    def test_no_opengl(self):
        """A picture says what to install where EGL has no driver."""
        result = self.run_here(MESH, SKY, *SMALL, "-o", "a.exr", "--quiet", __EGL_VENDOR_LIBRARY_FILENAMES="/nowhere",
                               LD_LIBRARY_PATH="/nowhere")
        self.assertEqual(result.returncode, 1, result)
        self.assertIn("install Mesa's EGL", result.stderr)


if __name__ == "__main__":
    with tempfile.TemporaryDirectory() as probe:
        tried = run(probe, MESH, SKY, *SMALL, "-o", "probe.exr", "--quiet")
    if "no OpenGL 4.1 without a window here" in tried.stderr:
        print("skipped:", tried.stderr)
        sys.exit(77)
    unittest.main(verbosity=2)
