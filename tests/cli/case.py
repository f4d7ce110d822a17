# SPDX-License-Identifier: Apache-2.0
"""What tests of the executables share: a folder for each test, and what is done in it."""
import os
import shutil
import subprocess
import tempfile
import unittest

BIN = os.environ["VMLIGHT_BIN"]
SOURCE = os.environ["VMLIGHT_SOURCE"]
SPOT = os.path.join(SOURCE, "tests/data/spot.obj")
SKY = os.path.join(SOURCE, "tests/data/studio_small_03.hdr")
CONFIG = os.path.join(SOURCE, "configs/ocio/config.ocio")

QUAD = "v -1 -1 0\nv 1 -1 0\nv 1 1 0\nv -1 1 0\nvt 0 0\nvt 1 0\nvt 1 1\nvt 0 1\nvn 0 0 1\nf 1/1/1 2/2/1 3/3/1 4/4/1\n"
QUAD_WITHOUT_UV = "v -1 -1 0\nv 1 -1 0\nv 1 1 0\nf 1 2 3\n"


class Case(unittest.TestCase):
    """Each test has a folder of its own, and looks at the whole of it afterwards."""

    def setUp(self):
        self.folder = tempfile.mkdtemp(prefix="vmlight ü ")
        self.environment = {k: v for k, v in os.environ.items() if k != "OCIO"}

    def tearDown(self):
        shutil.rmtree(self.folder)

    def path(self, name):
        return os.path.join(self.folder, name)

    def file(self, name, content=b""):
        with open(self.path(name), "wb") as out:
            out.write(content.encode() if isinstance(content, str) else content)
        return self.path(name)

    def read(self, name):
        with open(self.path(name), "rb") as data:
            return data.read()

    def run_tool(self, *words):
        words = [os.path.join(BIN, words[0]), *words[1:]]
        return subprocess.run(words, capture_output=True, text=True, cwd=self.folder, env=self.environment, timeout=120)

    def done(self, *words):
        result = self.run_tool(*words)
        self.assertEqual(result.returncode, 0, result.stderr)
        return result.stdout + result.stderr

    def refused(self, code, text, *words):
        """The tool ends with `code`, says `text`, and changes nothing in the folder."""
        before = self.contents()
        result = self.run_tool(*words)
        self.assertEqual(result.returncode, code, (words, result.stdout, result.stderr))
        self.assertIn(text, result.stderr)
        self.assertTrue(result.stderr.startswith(words[0] + " ERROR: "), result.stderr)
        self.assertEqual(self.contents(), before, "something was left behind or changed")

    def contents(self):
        found = {}
        for folder, _, names in os.walk(self.folder):
            for name in names:
                with open(os.path.join(folder, name), "rb") as data:
                    found[os.path.join(folder, name)] = data.read()
        return found

    def oiiotool(self, *words):
        return subprocess.run(["oiiotool", *words], check=True, capture_output=True, text=True, cwd=self.folder,
                              env=self.environment).stdout

    def assert_same_pixels(self, a, b, tolerance):
        # One threshold for all: a share of 0 % may fail.
        self.oiiotool(a, b, "--fail", str(tolerance), "--diff")

    def vismap(self, resolution="32"):
        self.file("quad.obj", QUAD)
        self.done("makevismap", "quad.obj", "-o", "vm.exr", "--resolution", resolution, "--samples", "8", "--quiet")
        return "vm.exr"

    def sky(self, *color, size="16x8", name="sky.exr"):
        self.oiiotool("--pattern", "constant:color=" + ",".join(map(str, color)), size, str(len(color)), "-d", "float",
                      "-o", name)
        return name
