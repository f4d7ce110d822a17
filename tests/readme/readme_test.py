# SPDX-License-Identifier: Apache-2.0
"""The commands of README's chapter "In a pipeline", as a reader would type them, from an installed tree.

Run with VMLIGHT_SOURCE (the repository) and VMLIGHT_PREFIX (where it is installed, for /opt/vmlight). The folder that they
run in holds what the chapter says it does: hero.obj and studio.hdr.
"""
import os
import re
import shutil
import subprocess
import tempfile
import unittest

SOURCE = os.environ["VMLIGHT_SOURCE"]
PREFIX = os.environ["VMLIGHT_PREFIX"]
CHAPTER = "## In a pipeline"


def commands():
    with open(os.path.join(SOURCE, "README.md")) as readme:
        chapter = readme.read().split("\n" + CHAPTER + "\n")[1].split("\n## ")[0]
    return [line[4:] for line in chapter.splitlines() if line.startswith("    ")]


class Readme(unittest.TestCase):
    def test_the_chapter_in_a_pipeline_works_as_it_stands(self):
        for program in "oiiotool", "maketx":
            if not shutil.which(program):
                self.skipTest(program + " is not installed")
        lines = commands()
        self.assertGreater(len(lines), 10)
        folder = tempfile.mkdtemp(prefix="vmlight-readme-")
        self.addCleanup(shutil.rmtree, folder)
        shutil.copy(os.path.join(SOURCE, "tests/data/spot.obj"), os.path.join(folder, "hero.obj"))
        shutil.copy(os.path.join(SOURCE, "tests/data/studio_small_03.hdr"), os.path.join(folder, "studio.hdr"))
        python = "/usr/bin/python3"  # the one that Debian's module belongs to
        if subprocess.run([python, "-c", "import OpenImageIO"], capture_output=True).returncode != 0:
            print("Python's module OpenImageIO is not installed: its command is left out")
            lines = [line for line in lines if not line.startswith("python3 ")]
        setup = ["set -eu", f'python3() {{ {python} "$@"; }}']
        script = "\n".join([*setup, *lines]).replace("/opt/vmlight", PREFIX)
        environment = {k: v for k, v in os.environ.items() if k not in ("OCIO", "OIIO_LIBRARY_PATH")}
        result = subprocess.run(["bash", "-x", "-c", script], capture_output=True, text=True, cwd=folder,
                                env=environment, timeout=500)
        self.assertEqual(result.returncode, 0, result.stdout + result.stderr)
        made = os.listdir(folder)
        for output in re.findall(r"-o '?([^\s']+)", "\n".join(lines)):
            pattern = re.escape(output).replace("<UDIM>", r"1\d\d\d")
            self.assertTrue(any(re.fullmatch(pattern, name) for name in made), (output, made))


if __name__ == "__main__":
    unittest.main()
