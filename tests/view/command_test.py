#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""vmview's command line, without a display. Skipped (77) where EGL gives no OpenGL."""
import os
import subprocess
import sys
import tempfile
import unittest

BIN = os.environ["VMLIGHT_BIN"]
DATA = os.path.join(os.environ["VMLIGHT_SOURCE"], "tests", "data")
MESH, SKY = DATA + "/cases/box.obj", DATA + "/studio_small_03.hdr"
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

    def test_same_picture_twice(self):
        for name in ("a.exr", "b.exr"):
            self.run_here(MESH, SKY, *SMALL, "-o", name, "--quiet")
        with open(self.folder.name + "/a.exr", "rb") as a, open(self.folder.name + "/b.exr", "rb") as b:
            self.assertEqual(a.read(), b.read())

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
