# SPDX-License-Identifier: Apache-2.0
"""The commands of the documentation, as a reader would type them, from an installed tree: the chapter "Quick start" of
README.md, and docs/pipeline.md from "Try it" on.

Run with VMLIGHT_SOURCE (the repository), VMLIGHT_PREFIX (where it is installed, in place of /opt/vmlight) and VMLIGHT_PRELOAD
(what a host must load first, or nothing).
"""
import os
import re
import shutil
import subprocess
import tempfile
import unittest

SOURCE = os.environ["VMLIGHT_SOURCE"]
PREFIX = os.environ["VMLIGHT_PREFIX"]
PYTHON = "/usr/bin/python3"  # the one that Debian's module belongs to


def commands(page, chapter):
    """The indented lines below the heading "## `chapter`" of a page, up to the next heading of that level."""
    with open(os.path.join(SOURCE, page)) as file:
        text = file.read().split(f"\n## {chapter}\n")[1].split("\n## ")[0]
    return [line[4:] for line in text.splitlines() if line.startswith("    ")]


class Commands(unittest.TestCase):
    def setUp(self):
        for program in "oiiotool", "maketx":
            if not shutil.which(program):
                self.skipTest(program + " is not installed")
        self.folder = tempfile.mkdtemp(prefix="vmlight-readme-")
        self.addCleanup(shutil.rmtree, self.folder)

    def run_all(self, lines, count):
        """Each line must succeed and write the file after its -o. There must be at least `count` lines."""
        self.assertGreaterEqual(len(lines), count)
        setup = ["set -eu"]
        for host, program in ("oiiotool", "oiiotool"), ("maketx", "maketx"), ("python3", PYTHON):
            setup.append('%s() { LD_PRELOAD=$VMLIGHT_PRELOAD ASAN_OPTIONS=detect_leaks=0 command %s "$@"; }'
                         % (host, program))
        script = "\n".join([*setup, *lines]).replace("/opt/vmlight", PREFIX)
        environment = {k: v for k, v in os.environ.items() if k not in ("OCIO", "OIIO_LIBRARY_PATH")}
        result = subprocess.run(["bash", "-x", "-c", script], capture_output=True, text=True, cwd=self.folder,
                                env=environment, timeout=500)
        self.assertEqual(result.returncode, 0, result.stdout + result.stderr)
        written = os.listdir(self.folder)
        for output in re.findall(r"-o '?([^\s']+)", "\n".join(lines)):
            pattern = re.escape(output).replace("<UDIM>", r"1\d\d\d").replace(r"\#", r"\d")
            self.assertTrue(any(re.fullmatch(pattern, name) for name in written), (output, written))

    def test_quick_start(self):
        for name in "tests", "configs":
            os.symlink(os.path.join(SOURCE, name), os.path.join(self.folder, name))
        self.run_all(commands("README.md", "Quick start"), 8)

    def test_pipeline(self):
        shutil.copy(os.path.join(SOURCE, "tests/data/spot.obj"), os.path.join(self.folder, "hero.obj"))
        shutil.copy(os.path.join(SOURCE, "tests/data/studio_small_03.hdr"), os.path.join(self.folder, "studio.hdr"))
        lines = commands("docs/pipeline.md", "Try it")
        if subprocess.run([PYTHON, "-c", "import OpenImageIO"], capture_output=True).returncode != 0:
            print("Python's module OpenImageIO is not installed: its command is left out")
            lines = [line for line in lines if not line.startswith("python3 ")]
        self.run_all(lines, 20)


if __name__ == "__main__":
    unittest.main()
