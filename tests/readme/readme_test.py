# SPDX-License-Identifier: Apache-2.0
"""The commands of the documentation, as a reader would type them, from an installed tree: the chapter "Quick start" of
README.md, docs/pipeline.md from "Try it" on, and the "Safe commands" of docs/other-programs.md. As they stand, but for the
size of what they make, to be quick.

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
    return [smaller(line[4:]) for line in text.splitlines() if line.startswith("    ")]


def smaller(line):
    """The command with a quarter of each --resolution, so that a recipe which is baked at each use is baked quickly."""
    return re.sub(r"(--resolution )(\d+)", lambda found: found.group(1) + str(int(found.group(2)) // 4), line)


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
        shutil.copy(os.path.join(SOURCE, "tests/data/kloppenheim_05.hdr"), os.path.join(self.folder, "sunny.hdr"))
        lines = commands("docs/pipeline.md", "Try it")
        if subprocess.run([PYTHON, "-c", "import OpenImageIO"], capture_output=True).returncode != 0:
            print("Python's module OpenImageIO is not installed: its command is left out")
            lines = [line for line in lines if not line.startswith("python3 ")]
        self.run_all(lines, 20)

    def test_safe_commands(self):
        setup = commands("docs/pipeline.md", "Try it")[:2]
        # Light that is negative in Rec.709 too, and a green of one half as ACEScg.
        light = "constant:color=1,-0.2,0.5"
        inputs = [
            f"oiiotool --pattern {light} 8x8 3 -d float -o hero_lit.exr",
            "oiiotool --pattern constant:color=0.5,0.6,-0.3,0.2 8x8 4 -d float"
            " --chnames visibility,direction.x,direction.y,direction.z -o hero_vismap.exr",
            "oiiotool hero_lit.exr hero_vismap.exr --chappend --attrib colorInteropID lin_ap1_scene -o hero_all.exr",
        ]
        # Rec.709 of `light`, by the matrix from AP1 to Rec.709 with Bradford's adaptation.
        converted = [1.70505 * 1 + 0.62179 * 0.2 - 0.08326 * 0.5, -0.13026 * 1 - 1.14080 * 0.2 - 0.01055 * 0.5,
                     -0.02400 * 1 + 0.12897 * 0.2 + 1.15297 * 0.5]

        def same(name, values, tolerance):
            values = ",".join(f"{value:.5f}" for value in values)
            count = values.count(",") + 1
            return (f"oiiotool {name} --pattern constant:color={values} 8x8 {count} --fail {tolerance}"
                    f" --hardfail {tolerance} --diff")

        def positive(values):
            return [max(0, value) for value in values]

        data = [0.5, 0.6, -0.3, 0.2]
        checks = [
            same("hero_lit.hdr", positive([1, -0.2, 0.5]), 0.01),
            same("hero_lit_709.exr", converted, 1e-3),
            same("hero_lit_709.hdr", positive(converted), 0.02),
            same("hero_all_709.exr", converted + data, 1e-3),
            same("hero_lit_flipped.exr", [1, -0.2, 0.5], 0),
            same("hero_v.exr", [data[0]] * 3, 0),
            same("hero_b.exr", data[1:], 0),
            "for name in hero_lit_709 hero_all_709; do",
            "  oiiotool --info -v $name.exr | grep 'colorInteropID: \"lin_rec709_scene\"'",
            "done",
        ]
        safe = commands("docs/other-programs.md", "Safe commands")
        self.assertEqual(len(safe), 8)
        self.run_all(setup + inputs + safe + checks, 18)


if __name__ == "__main__":
    unittest.main()
