# SPDX-License-Identifier: Apache-2.0
"""The executables as a user meets them: what they refuse, how, and what they leave behind.

Run as: cli_test.py [CASE ...], with VMLIGHT_BIN (the executables' folder), VMLIGHT_SOURCE (the repository) and oiiotool
on the path. Each TestCase is one CTest test.
"""
import os
import pty
import resource
import shutil
import signal
import struct
import subprocess
import sys
import tempfile
import time
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


class Usage(Case):
    TOOLS = {"makevismap": ["quad.obj"], "makecfem": ["sky.exr"], "makelightmap": ["vm.exr", "sky.exr"]}

    def setUp(self):
        super().setUp()
        self.vismap()
        self.sky(1, 1, 1)

    def test_help_and_version_end_with_0(self):
        for tool in self.TOOLS:
            self.assertIn("Usage: " + tool, self.done(tool, "--help"))
            self.assertRegex(self.done(tool, "--version"), r"\d+\.\d+\.\d+")

    def test_quiet_says_nothing(self):
        for tool, operands in self.TOOLS.items():
            small = [] if tool == "makelightmap" else ["--resolution", "32"]
            self.assertEqual(self.done(tool, *operands, *small, "-o", "x.exr", "--quiet"), "", tool)

    def test_an_unknown_flag_is_refused_with_the_nearest(self):
        self.refused(2, 'unknown flag "--sample"; did you mean --samples?', "makevismap", "quad.obj", "-o", "x.exr",
                     "--sample", "4")
        self.refused(2, 'unknown flag "-x"', "makecfem", "sky.exr", "-x", "-o", "x.exr")
        self.refused(2, 'unknown flag "--rotation"', "makelightmap", "vm.exr", "sky.exr", "-o", "x.exr",
                     "--rotation=1,2,3")

    def test_a_missing_or_surplus_argument_is_named(self):
        self.refused(2, "-o OUTPUT.exr is missing", "makevismap", "quad.obj")
        for tool, operands in self.TOOLS.items():
            self.refused(2, " is missing", tool, "-o", "x.exr")
            self.refused(2, '"surplus" is one argument too many', tool, *operands, "surplus", "-o", "x.exr")
        self.refused(2, "", "makevismap", "quad.obj", "-o")
        self.refused(2, "", "makevismap", "quad.obj", "-o", "x.exr", "--samples")

    def test_values_are_parsed_strictly(self):
        for flag, value, text in [
                ("--samples", "0", "samples: 0 is not in [1, 1048576]"),
                ("--samples", "4x", 'samples: "4x" is not a whole number'),
                ("--samples", "", 'samples: "" is not a whole number'),
                ("--resolution", "0", 'resolution: "0" is not WIDTHxHEIGHT from 1x1 to 32768x32768'),
                ("--resolution", "99999", "resolution:"),
                ("--sampler", "random", 'sampler: "random" is not one of fibonacci, sobol, halton'),
                ("--max-distance", "far", 'max_distance: "far" is not a number or "infinite"'),
                ("--max-distance", "nan", 'max_distance: "nan" is not a number'),
                ("--max-distance", "-1", "max_distance: -1 is not in [0, 1e+30] or \"infinite\""),
                ("--margin", "-2", "margin: -2 is not in"),
                ("--format", "double", 'format: "double" is not one of float, half'),
                ("--threads", "-1", "threads: -1 is not in [0, 1024]"),
                ("--uv-set", "8", "uv_set: 8 is not in [0, 7]")]:
            self.refused(2, text, "makevismap", "quad.obj", "-o", "x.exr", flag, value)
            self.refused(2, text, "makevismap", "quad.obj", "-o", "x.exr", flag + "=" + value)
        self.refused(2, "--coverage takes no value", "makevismap", "quad.obj", "-o", "x.exr", "--coverage=1")

    def test_values_may_begin_with_a_minus_or_follow_an_equals_sign(self):
        self.done("makelightmap", "vm.exr", "sky.exr", "-o", "a.exr", "--rotate", "-90,0,0", "--exposure", "-1")
        self.done("makelightmap", "vm.exr", "sky.exr", "-o=b.exr", "--rotate=-90,0,0", "--exposure=-1")
        self.assertEqual(self.read("a.exr"), self.read("b.exr"))

    def test_frames_are_refused_in_words(self):
        lightmap = ["makelightmap", "vm.exr", "sky.exr"]
        self.refused(2, "is not a range of frames", *lightmap, "-o", "x.#.exr", "--frames", "1-x")
        self.refused(2, "is not a range of frames", *lightmap, "-o", "x.#.exr", "--frames", "")
        self.refused(2, "is not FIRST:LAST or one number", *lightmap, "-o", "x.#.exr", "--rotate-y", "0:b")
        for endless in "1-2000000000", "1-3x0", "1-3x", "1-3x00,5":
            self.refused(2, "up to 999999", *lightmap, "-o", "x.#.exr", "--frames", endless)
        self.refused(2, "from 0 to 90 degrees needs --frames", *lightmap, "-o", "x.exr", "--rotate-y", "0:90")
        self.refused(2, "4 frames need a name with ####", *lightmap, "-o", "x.exr", "--frames", "1-4")

    def test_flags_that_do_not_go_together_are_wrong_usage_before_any_work(self):
        mirror = ["--matrix", "-1,0,0,0,1,0,0,0,1"]
        for text, flags in (("only one of rotate, matrix and quaternion", ["--rotate", "1,2,3", *mirror]),
                            ("matrix: a mirror, not a rotation", mirror),
                            ("matrix: not a rotation", ["--matrix", "1,0,0,0,1,0,0,0,2"]),
                            ("quaternion: 0,0,0,0 has no direction", ["--quaternion", "0,0,0,0"]),
                            ("environment is given too", ["--cfem", "sky.exr"]),
                            ("vismap is missing", ["--vismap", ""]),
                            ("environment is missing, or cfem", ["--environment", ""])):
            self.refused(2, "makelightmap ERROR: " + text, "makelightmap", "vm.exr", "sky.exr", "-o", "x.exr", *flags)
            # Nothing was read: none of these files is there.
            self.refused(2, text, "makelightmap", "gone.exr", "gone.exr", "-o", "x.exr", *flags)
        for tool, operands in self.TOOLS.items():
            self.refused(2, " is missing", tool, *[""] * len(operands), "-o", "x.exr")
        # The fault of a recipe is none of the command line, unless its flags made it.
        self.file("mirror.lightmap", 'vismap = "vm.exr"\nenvironment = "sky.exr"\nmatrix = [-1, 0, 0, 0, 1, 0, 0, 0, 1]\n')
        self.refused(1, '"mirror.lightmap" line 3: matrix: a mirror', "makelightmap", "mirror.lightmap", "-o", "x.exr")
        self.refused(2, "only one of rotate", "makelightmap", "mirror.lightmap", "-o", "x.exr", "--rotate", "0,90,0")
        self.done("makelightmap", "mirror.lightmap", "-o", "x.exr", "--rotate", "0,90,0", "--matrix=")

    def test_a_flag_that_cannot_change_the_picture_is_refused(self):
        self.done("makecfem", "sky.exr", "-o", "cfem.exr", "--order", "2", "--filter", "sh")
        bake = ["makevismap", "quad.obj", "-o", "x.exr"]
        lit, filtered = ["makelightmap", "vm.exr", "cfem.exr", "-o", "x.exr"], '"cfem.exr" is filtered already'
        environment = ["makelightmap", "vm.exr", "sky.exr", "-o", "x.exr"]
        for text, words in (
                ("--order 3: only the filter sh uses it", ["makecfem", "sky.exr", "-o", "x.exr", "--order", "3"]),
                ("--cfem-order 2: only the filter sh uses it", [*environment, "--cfem-order=2"]),
                ("--albedo-colorspace ACEScg: there is no albedo", [*environment, "--albedo-colorspace", "ACEScg"]),
                ("--cfem-filter sh: there is no environment to filter: " + filtered, [*lit, "--cfem-filter", "sh"]),
                ("--cfem-sanitize: there is no environment to filter: " + filtered, [*lit, "--cfem-sanitize"]),
                ("--colorspace data: there is no environment to convert: " + filtered, [*lit, "--colorspace", "data"]),
                ("--cfem-resolution 8: there is no environment", [*environment, "--is-cfem", "--cfem-resolution", "8"]),
                ("--crease-angle 30: flat normals", [*bake, "--normals", "flat", "--crease-angle", "30"]),
                ("--resolution 8: width and height", [*bake, "--resolution", "8", "--width", "4", "--height", "4"])):
            self.refused(2, f"{words[0]} ERROR: {text}", *words)
        # By flags only: a recipe may keep what it does not use just now.
        self.file("a.lightmap", 'vismap = "vm.exr"\ncfem = "cfem.exr"\ncfem_order = 5\ncolorspace = "data"\n')
        self.done("makelightmap", "a.lightmap", "-o", "x.exr")
        self.done(*environment, "--cfem-filter=sh", "--cfem-order=2")
        self.done(*bake, "--resolution=8x9", "--height=4", "--samples=1")


class Outputs(Case):
    def setUp(self):
        super().setUp()
        self.vismap()
        self.file("old.exr", "the old picture")

    def test_a_name_that_cannot_be_written_is_refused_before_the_work(self):
        self.refused(2, '"x.png": outputs are EXR files', "makevismap", "quad.obj", "-o", "x.png")
        self.refused(1, 'no folder "missing"', "makevismap", "quad.obj", "-o", "missing/x.exr")
        if os.path.isdir("/proc"):  # takes no files, though root may write to it
            self.refused(1, '"/proc/x.exr": the folder "/proc" cannot be written: ', "makevismap", "gone.obj", "-o",
                         "/proc/x.exr")
        os.mkdir(self.path("folder.exr"))
        self.refused(1, '"folder.exr": is a folder', "makevismap", "quad.obj", "-o", "folder.exr")
        os.mkdir(self.path("pipes"))
        os.mkfifo(self.path("pipes/x.exr"))
        process = self.run_tool("makevismap", "quad.obj", "-o", "pipes/x.exr")
        self.assertEqual((process.returncode, "is a device or a pipe" in process.stderr), (1, True), process.stderr)
        os.remove(self.path("pipes/x.exr"))  # contents() would wait for its writer
        if os.geteuid() != 0:
            os.mkdir(self.path("locked"), 0o500)
            self.refused(1, "cannot be written", "makevismap", "quad.obj", "-o", "locked/x.exr")

    def test_a_failed_run_leaves_the_old_file(self):
        self.file("bad.obj", QUAD_WITHOUT_UV)
        self.refused(1, "no texture coordinates", "makevismap", "bad.obj", "-o", "old.exr")
        self.refused(1, "no such file", "makecfem", "missing.exr", "-o", "old.exr")
        self.refused(1, "no such file", "makelightmap", "vm.exr", "missing.exr", "-o", "old.exr")

    def test_a_full_disk_is_told_and_leaves_the_old_file(self):
        def fill_disk():
            resource.setrlimit(resource.RLIMIT_FSIZE, (100000, 100000))
        before = self.contents()
        for threads in "1", "4":
            # Unless SIGXFSZ is ignored, as Python does, it ends the process.
            result = subprocess.run([os.path.join(BIN, "makevismap"), SPOT, "-o", "old.exr", "--resolution", "512",
                                     "--samples", "4", "--threads", threads], cwd=self.folder, capture_output=True,
                                    text=True, timeout=60, preexec_fn=fill_disk, restore_signals=False)
            self.assertEqual(result.returncode, 1, result.stderr)
            self.assertIn('makevismap ERROR: "old.exr": File too large', result.stderr)
            self.assertEqual(self.contents(), before)

    def test_half_is_refused_where_it_would_overflow(self):
        self.sky(1e5, 1, 1)
        self.refused(1, "beyond the range of half", "makecfem", "sky.exr", "-o", "old.exr", "--format", "half")
        self.done("makecfem", "sky.exr", "-o", "old.exr")

    def test_same_inputs_give_the_same_bytes_for_any_number_of_threads(self):
        for threads in "1", "2", "7":
            self.done("makevismap", SPOT, "-o", f"vm{threads}.exr", "--resolution", "128", "--samples", "16",
                      "--threads", threads)
            self.done("makecfem", SKY, "-o", f"cfem{threads}.exr", "--threads", threads)
            self.done("makelightmap", f"vm{threads}.exr", f"cfem{threads}.exr", "-o", f"lit{threads}.exr",
                      "--threads", threads)
            time.sleep(1.1 if threads == "1" else 0)  # a date in the file would differ now
        for stage in "vm", "cfem", "lit":
            self.assertEqual(self.read(stage + "1.exr"), self.read(stage + "2.exr"), stage)
            self.assertEqual(self.read(stage + "1.exr"), self.read(stage + "7.exr"), stage)
        for word in self.folder, "makevismap", "--resolution":
            self.assertNotIn(word.encode(), self.read("vm1.exr"))

    def test_an_interrupt_leaves_the_old_file_and_no_debris(self):
        before = self.contents()
        for number in signal.SIGINT, signal.SIGTERM, signal.SIGHUP:
            process = subprocess.Popen([os.path.join(BIN, "makevismap"), SPOT, "-o", "old.exr", "--resolution", "4096",
                                        "--samples", "65536"], cwd=self.folder, stderr=subprocess.PIPE, text=True)
            line = process.stderr.readline()  # the bake is under way
            process.send_signal(number)
            _, rest = process.communicate(timeout=60)
            self.assertEqual(process.returncode, 1, rest)
            self.assertIn("makevismap ERROR: interrupted", line + rest)
            self.assertEqual(self.contents(), before)

    def test_an_interrupt_need_not_wait_for_a_mesh_to_be_read(self):
        self.file("large.obj", QUAD + "v 1 1 1\nv 1 1 2\nv 2 1 1\n" * 500000)
        before = self.contents()
        process = subprocess.Popen([os.path.join(BIN, "makevismap"), "large.obj", "-o", "old.exr", "--resolution", "8"],
                                   cwd=self.folder, stderr=subprocess.PIPE, text=True)
        caught = 0
        while process.poll() is None and not caught >> (signal.SIGINT - 1) & 1:
            with open(f"/proc/{process.pid}/status") as status:
                caught = next(int(line.split()[1], 16) for line in status if line.startswith("SigCgt:"))
        process.send_signal(signal.SIGINT)
        _, rest = process.communicate(timeout=60)
        self.assertEqual((process.returncode, rest), (1, "makevismap ERROR: interrupted\n"))
        self.assertEqual(self.contents(), before)

    def test_progress_tells_share_rate_and_time_left(self):
        words = [os.path.join(BIN, "makevismap"), SPOT, "-o", "x.exr", "--resolution", "256", "--samples", "2048",
                 "--threads", "1"]
        ours, theirs = pty.openpty()
        process = subprocess.Popen(words, cwd=self.folder, stdout=subprocess.DEVNULL, stderr=theirs)
        os.close(theirs)
        shown = b""
        try:
            while piece := os.read(ours, 4096):
                shown += piece
        except OSError:  # the other side is closed
            pass
        os.close(ours)
        self.assertEqual(process.wait(timeout=60), 0, shown)
        line = rb" %  [\d.]+ [kMG]? ?texels/s  \d\d:\d\d"
        self.assertRegex(shown, rb"\rbake +\d+" + line + b" left *\r")
        self.assertRegex(shown, rb"\rbake 100" + line + b" *\r\n")
        # In a file: a line for each tenth, and no carriage return.
        lines = self.run_tool(*words).stderr
        self.assertRegex(lines, r"(?m)^bake +\d+ %  [\d.]+ k texels/s  \d\d:\d\d left$")
        self.assertLessEqual(lines.count("bake"), 11)
        self.assertNotIn("\r", lines)


class Meshes(Case):
    def test_what_is_not_a_mesh_is_refused_in_words(self):
        self.refused(1, '"missing.obj": no such file', "makevismap", "missing.obj", "-o", "x.exr")
        os.mkdir(self.path("folder.obj"))
        self.refused(1, '"folder.obj": not a file', "makevismap", "folder.obj", "-o", "x.exr")
        self.file("empty.obj")
        self.file("noise.obj", bytes(range(256)) * 64)
        self.file("noise.glb", b"glTF" + bytes(range(256)) * 64)
        self.file("noise.ply", b"ply\nformat ascii 1.0\nelement vertex 3\n" + bytes(range(256)))
        self.file("huge.ply", "ply\nformat ascii 1.0\nelement vertex 99999999999\nproperty float x\nend_header\n")
        self.file("text.txt", "hello")
        self.file("points.obj", "v 0 0 0\nv 1 0 0\nl 1 2\n")
        self.file("cut.glb", b"glTF\x02\0\0\0")
        for name in "empty.obj", "noise.obj", "noise.glb", "noise.ply", "huge.ply", "text.txt", "points.obj", "cut.glb":
            self.refused(1, f'"{name}": ', "makevismap", name, "-o", "x.exr")

    def test_a_mesh_without_uvs_says_so(self):
        self.file("bare.obj", QUAD_WITHOUT_UV)
        self.refused(1, '"bare.obj": no texture coordinates', "makevismap", "bare.obj", "-o", "x.exr")
        os.mkdir(self.path("meshes"))
        self.file("meshes/bare.obj", QUAD_WITHOUT_UV)
        self.refused(1, '"meshes/bare.obj": no texture coordinates', "makevismap", "meshes/bare.obj", "-o", "x.exr")
        self.file("quad.obj", QUAD)
        self.refused(1, "no texture coordinates", "makevismap", "quad.obj", "-o", "x.exr", "--uv-set", "1")

    def test_a_vertex_that_is_not_finite_is_named(self):
        self.file("nan.obj", QUAD.replace("v 1 1 0", "v nan 1 0"))
        self.refused(1, "is not finite", "makevismap", "nan.obj", "-o", "x.exr")

    def test_surprises_are_warned_about_with_their_counts(self):
        double = QUAD + "f 1/1/1 2/2/1 3/3/1\n"
        self.file("double.obj", double)
        out = self.done("makevismap", "double.obj", "-o", "x.exr", "--resolution", "8", "--samples", "4")
        self.assertRegex(out, r"WARNING: 36 texels \(56.25 % of those covered\) belong to more than one triangle")
        self.file("outside.obj", QUAD.replace("vt 1 1", "vt 2 2"))
        out = self.done("makevismap", "outside.obj", "-o", "x.exr", "--resolution", "8", "--samples", "4")
        self.assertIn("WARNING: 2 of 2 triangles reach out of [0,1]", out)
        # A map of one texel, and one triangle of two.
        self.file("one.obj", QUAD.replace("f 1/1/1 2/2/1 3/3/1 4/4/1", "vt 2 2\n" + 2 * "f 1/1/1 2/2/1 3/3/1\n" +
                                          "f 1/1/1 2/2/1 3/5/1"))
        out = self.done("makevismap", "one.obj", "-o", "x.exr", "--resolution", "1", "--samples", "4")
        self.assertIn("uv: 3 triangles cover", out)
        self.assertIn("; 1 texel overlaps;", out)
        self.assertIn("WARNING: 1 texel (100.00 % of those covered) belongs to more than one triangle: the first triangle "
                      "of the file has it", out)
        self.assertIn("WARNING: 1 of 3 triangles reaches out of [0,1]", out)

    def test_an_occluder_casts(self):
        self.file("quad.obj", QUAD)
        self.file("lid.obj", "v -9 -9 0.1\nv 9 -9 0.1\nv 9 9 0.1\nv -9 9 0.1\nf 1 2 3 4\n")
        self.done("makevismap", "quad.obj", "-o", "open.exr", "--resolution", "4", "--samples", "64")
        self.done("makevismap", "quad.obj", "--occluder", "lid.obj", "-o", "lid.exr", "--resolution", "4",
                  "--samples", "64")
        self.assertIn("Stats Min: 1.000000", self.oiiotool("open.exr", "--ch", "visibility", "--printstats"))
        self.assertIn("Stats Max: 0.0", self.oiiotool("lid.exr", "--ch", "visibility", "--printstats"))
        self.refused(1, '"gone.obj": no such file', "makevismap", "quad.obj", "--occluder", "gone.obj", "-o", "x.exr")


class Light(Case):
    def test_a_constant_sky_lights_by_visibility_alone(self):
        self.done("makevismap", SPOT, "-o", "vm.exr", "--resolution", "128", "--samples", "16")
        self.sky(0.25, 0.5, 2)
        self.done("makelightmap", "vm.exr", "sky.exr", "-o", "lit.exr", "--rotate", "10,20,30")
        self.oiiotool("vm.exr", "--ch", "visibility,visibility,visibility", "--chnames", "R,G,B", "--mulc",
                      "0.25,0.5,2", "-o", "expected.exr")
        self.assert_same_pixels("lit.exr", "expected.exr", 2e-6)

    def test_frames_equal_single_maps_at_their_angles(self):
        self.done("makevismap", SPOT, "-o", "vm.exr", "--resolution", "64", "--samples", "16")
        self.done("makecfem", SKY, "-o", "cfem.exr")
        self.done("makelightmap", "vm.exr", "cfem.exr", "-o", "lit.####.exr", "--frames", "9-12", "--rotate-y", "0:270")
        for frame, angle in ("0009", 0), ("0010", 90), ("0011", 180), ("0012", 270):
            self.done("makelightmap", "vm.exr", "cfem.exr", "-o", "one.exr", "--rotate", f"0,{angle},0")
            self.assert_same_pixels(f"lit.{frame}.exr", "one.exr", 1e-6)
        self.assertFalse(os.path.exists(self.path("lit.0013.exr")))

    def test_an_environment_is_filtered_as_makecfem_would(self):
        self.vismap()
        self.done("makecfem", SKY, "-o", "cfem.exr")
        self.done("makelightmap", "vm.exr", "cfem.exr", "-o", "a.exr")
        self.done("makelightmap", "vm.exr", SKY, "-o", "b.exr", "--model", "paper")
        self.assert_same_pixels("a.exr", "b.exr", 0)

    def test_ao_needs_normals(self):
        self.done("makevismap", SPOT, "-o", "vm.exr", "--resolution", "64", "--samples", "16")
        self.done("makecfem", SKY, "-o", "cfem.exr", "--resolution", "64")
        words = ["cfem.exr", "--model", "ao", "-o", "lit.exr"]
        self.refused(1, "the model ao needs the normals that makevismap --normal bakes", "makelightmap", "vm.exr",
                     *words)
        self.assertFalse(os.path.exists(self.path("lit.exr")))
        self.done("makevismap", SPOT, "-o", "vmn.exr", "--resolution", "64", "--samples", "16", "--normal")
        self.done("makelightmap", "vmn.exr", *words)
        self.file("n.vismap", f'mesh = "{SPOT}"\nresolution = 64\nsamples = 16\nnormal = true\n')
        self.done("makelightmap", "n.vismap", *words[:-1], "live.exr")
        self.assertEqual(self.read("live.exr"), self.read("lit.exr"))
        self.done("makelightmap", "vmn.exr", "cfem.exr", "-o", "a.exr")
        self.done("makelightmap", "vm.exr", "cfem.exr", "-o", "b.exr")
        self.assert_same_pixels("a.exr", "b.exr", 0)

    def test_a_stack_lights_by_lobes(self):
        self.vismap()
        self.done("makecfem", SKY, "-o", "cfem.exr")
        self.assertIn("to 9 of 256x128", self.done("makecfem", SKY, "--stack", "-o", "stack.exr"))
        self.assertIn("model: lobe, since the CFEM is a stack", self.done("makelightmap", "vm.exr", "stack.exr", "-o",
                                                                          "stack_lit.exr"))
        self.assertIn("model: lobe, since the environment is filtered here",
                      self.done("makelightmap", "vm.exr", SKY, "-o", "env_lit.exr"))
        self.assertIn("model: paper, since the CFEM is no stack", self.done("makelightmap", "vm.exr", "cfem.exr", "-o",
                                                                            "paper_lit.exr"))
        self.assert_same_pixels("stack_lit.exr", "env_lit.exr", 0)
        # What knows no stacks reads the first image, a CFEM.
        self.assert_same_pixels("stack.exr", "cfem.exr", 0)
        self.done("makelightmap", "vm.exr", "stack.exr", "--model", "paper", "-o", "x.exr")
        self.assert_same_pixels("x.exr", "paper_lit.exr", 0)
        self.done("makecfem", SKY, "--stack", "-o", "again.exr", "--threads", "1")
        self.assertEqual(self.read("again.exr"), self.read("stack.exr"))
        self.oiiotool("stack.exr", "--subimage", "0", "-o", "first.exr")
        self.assertIn("model: paper", self.done("makelightmap", "vm.exr", "first.exr", "-o", "x.exr"))
        self.refused(1, '"cfem.exr": model lobe needs a stack of lobes', "makelightmap", "vm.exr", "cfem.exr", "--model",
                     "lobe", "-o", "none.exr")
        self.assertFalse(os.path.exists(self.path("none.exr")))
        self.done("makecfem", SKY, "--stack", "-o", "half.exr", "--format", "half")
        self.done("makelightmap", "vm.exr", "half.exr", "-o", "x.exr")
        self.assert_same_pixels("x.exr", "stack_lit.exr", 0.02)

    def test_the_same_light_in_two_colour_spaces_gives_the_same_map(self):
        self.vismap()
        self.oiiotool("--colorconfig", CONFIG, SKY, "--colorconvert", "lin_rec709_scene", "ACEScg", "-d", "float", "-o",
                      "sky_acescg.exr")
        config = ["--colorconfig", CONFIG]
        self.done("makelightmap", "vm.exr", SKY, *config, "-o", "a.exr", "--colorspace", "lin_rec709_scene")
        self.done("makelightmap", "vm.exr", "sky_acescg.exr", *config, "-o", "b.exr", "--colorspace", "ACEScg")
        self.assert_same_pixels("a.exr", "b.exr", 1e-4)
        self.refused(1, "Nonsense", "makelightmap", "vm.exr", SKY, *config, "-o", "x.exr", "--colorspace", "Nonsense")
        self.refused(1, "none is set (--colorconfig or $OCIO)", "makecfem", SKY, "--colorspace", "ACEScg", "-o", "x.exr")
        self.refused(1, "missing.ocio", "makecfem", SKY, "--colorconfig", "missing.ocio", "-o", "x.exr")

    def test_albedo_multiplies_in_linear_light(self):
        self.vismap()
        self.sky(1, 1, 1)
        self.oiiotool("--pattern", "constant:color=0.5,0.5,0.5", "8x8", "3", "-d", "uint8", "-o", "gray.png")
        self.done("makelightmap", "vm.exr", "sky.exr", "--albedo", "gray.png", "-o", "lit.exr")
        stats = self.oiiotool("lit.exr", "--printstats")
        self.assertIn("Stats Avg: 0.2158", stats.replace("0.215861", "0.2158"))  # sRGB 128 is 0.2159 in linear light
        self.refused(1, "no such file", "makelightmap", "vm.exr", "sky.exr", "--albedo", "gone.png", "-o", "x.exr")

    def test_what_is_not_light_or_visibility_is_refused(self):
        self.vismap()
        self.done("makecfem", SKY, "-o", "cfem.exr")
        self.done("makelightmap", "vm.exr", "cfem.exr", "-o", "lit.exr")
        self.file("noise.exr", bytes(range(256)) * 16)
        self.file("noise.hdr", "#?RADIANCE\n\n-Y 4 +X 4\n")
        self.file("empty.exr")
        with open(self.path("cfem.exr"), "rb") as whole:
            self.file("cut.exr", whole.read()[:5000])
        self.refused(1, "not a visibility map", "makelightmap", "cfem.exr", "cfem.exr", "-o", "x.exr")
        self.refused(1, "not a visibility map", "makelightmap", "lit.exr", "cfem.exr", "-o", "x.exr")
        self.refused(1, "neither an environment nor a CFEM", "makelightmap", "vm.exr", "vm.exr", "-o", "x.exr")
        self.refused(1, "neither an environment nor a CFEM", "makelightmap", "vm.exr", "lit.exr", "-o", "x.exr")
        self.refused(1, "visibility map", "makecfem", "vm.exr", "-o", "x.exr")
        for name in "noise.exr", "noise.hdr", "empty.exr", "cut.exr":
            self.refused(1, f'"{name}": ', "makecfem", name, "-o", "x.exr")
            self.refused(1, f'"{name}": ', "makelightmap", "vm.exr", name, "-o", "x.exr")
            self.refused(1, f'"{name}": ', "makelightmap", name, "cfem.exr", "-o", "x.exr")

    def test_bad_pixels_are_refused_unless_mending_is_asked_for(self):
        rows = b""
        for y in range(4):
            pixels = [(1.0, 1.0, 1.0)] * 8
            if y == 2:
                pixels[5] = (float("nan"), float("inf"), -1.0)
            rows += b"".join(struct.pack("<3f", *p) for p in reversed(pixels))
        # Little-endian PFM, bottom row first.
        flipped = b"".join(rows[i:i + 96] for i in range(0, len(rows), 96))
        self.file("bad.pfm", b"PF\n8 4\n-1.0\n" + flipped)
        self.refused(1, "environment has 3 values that are NaN, infinite or negative, the first at pixel (2, 1) channel ",
                     "makecfem", "bad.pfm", "-o", "x.exr")
        out = self.done("makecfem", "bad.pfm", "-o", "x.exr", "--sanitize")
        self.assertIn("3 bad values of the environment were mended", out)
        self.assertNotIn("nan", self.oiiotool("x.exr", "--printstats").lower().replace("nancount: 0", ""))


class Tiles(Case):
    """UDIM: a floor in tile 1001, a wall in 1002, and a lid in 1011."""

    CORNERS = ((.125, .125), (.875, .125), (.875, .75), (.125, .75))
    SMALL = ["--resolution", "32", "--samples", "16"]

    def setUp(self):
        super().setUp()
        self.mesh("hero.obj", ((0, 0), (1, 0), (0, 1)))
        self.sky(1, 2, 3)

    def mesh(self, name, places):
        text = "v -1 -1 0\nv 1 -1 0\nv 1 1 0\nv -1 1 0\nv 1 -1 2\nv 1 1 2\nv -1 -1 2\nv -1 1 2\n"
        for u, v in places:
            text += "".join(f"vt {x + u} {y + v}\n" for x, y in self.CORNERS)
        text += "vn 0 0 1\nvn -1 0 0\nvn 0 0 -1\nf 1/1/1 2/2/1 3/3/1 4/4/1\nf 2/5/2 5/6/2 6/7/2 3/8/2\n"
        self.file(name, text + "f 7/9/3 8/10/3 6/11/3 5/12/3\n")

    def bake(self):
        self.done("makevismap", "hero.obj", "-o", "vm.<UDIM>.exr", *self.SMALL)

    def names(self, start):
        return sorted(name for name in os.listdir(self.folder) if name.startswith(start))

    def test_a_tile_is_the_map_of_the_mesh_with_its_uvs_moved_there(self):
        out = self.done("makevismap", "hero.obj", "-o", "vm.<UDIM>.exr", *self.SMALL)
        self.assertEqual(self.names("vm"), ["vm.1001.exr", "vm.1002.exr", "vm.1011.exr"])
        self.assertNotIn("WARNING", out, "triangles of other tiles are no surprise")
        for udim, (u, v) in ((1001, (0, 0)), (1002, (1, 0)), (1011, (0, 1))):
            self.assertIn(f"tile {udim}: bake: ", out)
            self.mesh("moved.obj", [(a - u, b - v) for a, b in ((0, 0), (1, 0), (0, 1))])
            said = self.done("makevismap", "moved.obj", "-o", "moved.exr", *self.SMALL)
            self.assertIn("reach out of [0,1] in uv", said, "here they are")
            self.assert_same_pixels(f"vm.{udim}.exr", "moved.exr", 0)
            self.done("makevismap", "hero.obj", "-o", "one.exr", "--udim", str(udim), *self.SMALL)
            self.assertEqual(self.read("one.exr"), self.read(f"vm.{udim}.exr"))
            self.assertIn(f'vmlight:udim: "{udim}"', self.oiiotool("--info", "-v", "one.exr"))

    def test_a_list_chooses_tiles(self):
        self.done("makevismap", "hero.obj", "-o", "vm.<UDIM>.exr", "--udims", "1011,1001-1002", *self.SMALL)
        self.assertEqual(self.names("vm"), ["vm.1001.exr", "vm.1002.exr", "vm.1011.exr"])
        out = self.done("makevismap", "hero.obj", "-o", "empty.<UDIM>.exr", "--udims=1033", *self.SMALL)
        self.assertIn("WARNING: tile 1033: no texel centre is covered: the map is empty", out)
        self.done("makevismap", "hero.obj", "-o", "one.<UDIM>.exr", "--udim=1002", *self.SMALL)
        self.assertEqual(self.names("one"), ["one.1002.exr"])

    def test_what_straddles_a_border_or_lies_in_no_tile_is_warned_about(self):
        self.mesh("odd.obj", ((0, 0), (1.5, 0), (-3, 0)))
        out = self.done("makevismap", "odd.obj", "-o", "vm.<UDIM>.exr", *self.SMALL)
        self.assertEqual(self.names("vm"), ["vm.1001.exr", "vm.1002.exr", "vm.1003.exr"])
        self.assertIn("WARNING: tile 1002: 2 of 6 triangles reach out of tile 1002 in uv", out)
        self.assertEqual(out.count("2 of 6 triangles reach out of all UDIM tiles"), 1, "for each tile again")

    def test_a_lightmap_of_each_tile(self):
        self.bake()
        os.remove(self.path("vm.1002.exr"))
        out = self.done("makelightmap", "vm.<UDIM>.exr", "sky.exr", "-o", "lit.<UDIM>.exr")
        self.assertEqual(self.names("lit"), ["lit.1001.exr", "lit.1011.exr"])
        self.assertEqual(out.count("filter: "), 1, "filtered for each tile")
        for udim in "1001", "1011":
            self.assertIn(f"tile {udim}: light: 1 map", out)
            self.done("makelightmap", f"vm.{udim}.exr", "sky.exr", "-o", "one.exr")
            self.assert_same_pixels(f"lit.{udim}.exr", "one.exr", 0)
            self.done("makelightmap", "vm.<UDIM>.exr", "sky.exr", "-o", "one.exr", "--udim", udim)
            self.assertEqual(self.read(f"lit.{udim}.exr"), self.read("one.exr"))
        self.done("makelightmap", "vm.<UDIM>.exr", "sky.exr", "-o", "f.<UDIM>.##.exr", "--frames", "1-2", "--rotate-y=0:90")
        self.assertEqual(self.names("f."), ["f.1001.01.exr", "f.1001.02.exr", "f.1011.01.exr", "f.1011.02.exr"])

    def test_albedo_or_environment_may_tell_the_tiles(self):
        self.bake()
        for udim in "1002", "1003":
            self.sky(.5, .5, .5, name=f"paint.{udim}.exr")
        self.done("makelightmap", "vm.1001.exr", "sky.exr", "--albedo", "paint.<UDIM>.exr", "-o", "lit.<UDIM>.exr")
        self.assertEqual(self.names("lit"), ["lit.1002.exr", "lit.1003.exr"])
        self.done("makecfem", "paint.<UDIM>.exr", "-o", "cfem.<UDIM>.exr", "--resolution=8")
        self.assertEqual(self.names("cfem"), ["cfem.1002.exr", "cfem.1003.exr"])

    def test_the_mesh_of_a_vismap_recipe_tells_the_tiles(self):
        self.bake()
        self.file("hero.vismap", 'mesh = "hero.obj"\nresolution = 32\nsamples = 16\n')
        self.file("hero.lightmap", 'vismap = "hero.vismap?udim=<UDIM>"\nenvironment = "sky.exr"\n')
        self.done("makelightmap", "hero.lightmap", "-o", "lit.<UDIM>.exr")
        self.done("makelightmap", "vm.<UDIM>.exr", "sky.exr", "-o", "stored.<UDIM>.exr")
        self.assertEqual(self.names("lit"), ["lit.1001.exr", "lit.1002.exr", "lit.1011.exr"])
        for udim in "1001", "1002", "1011":
            self.assert_same_pixels(f"lit.{udim}.exr", f"stored.{udim}.exr", 0)
        self.refused(2, 'vismap: "hero.vismap" is of one tile; did you mean "hero.vismap?udim=<UDIM>"?', "makelightmap",
                     "hero.vismap", "sky.exr", "-o", "x.<UDIM>.exr")

    def test_a_recipe_under_the_name_of_a_tile_is_of_that_tile(self):
        self.bake()
        self.file("hero.lightmap", 'vismap = "vm.<UDIM>.exr"\nenvironment = "sky.exr"\n')
        os.symlink("hero.lightmap", self.path("hero.1011.lightmap"))
        self.done("makelightmap", "hero.1011.lightmap", "-o", "a.exr")
        self.done("makelightmap", "hero.lightmap", "--udim=1011", "-o", "b.exr")
        self.done("makelightmap", "hero.lightmap?udim=1011", "-o", "c.<UDIM>.exr")
        self.assertEqual(self.names("c."), ["c.1011.exr"])
        self.assertEqual(self.read("a.exr"), self.read("b.exr"))
        self.assertEqual(self.read("a.exr"), self.read("c.1011.exr"))
        self.assertIn("udim = 1011\n", self.done("makelightmap", "hero.1011.lightmap", "--print-recipe"))
        self.refused(2, "a recipe holds no --udims", "makelightmap", "hero.lightmap", "--udims=1001", "--print-recipe")

    def test_meshes_in_files_by_tile(self):
        os.rename(self.path("hero.obj"), self.path("part.1002.obj"))
        self.done("makevismap", "part.<UDIM>.obj", "-o", "vm.<UDIM>.exr", *self.SMALL)
        self.assertEqual(self.names("vm"), ["vm.1002.exr"])

    def test_what_would_be_the_wrong_picture_is_refused(self):
        self.bake()
        vismap = ["makevismap", "hero.obj", *self.SMALL]
        light = ["makelightmap", "vm.<UDIM>.exr", "sky.exr"]
        one = ["makelightmap", "vm.1001.exr", "sky.exr"]
        self.refused(2, '"x.exr": 3 tiles need a name with <UDIM> for the number', *light, "-o", "x.exr", "--udims",
                     "1001-1003")
        self.refused(2, '"x.exr": 2 tiles need', *light, "-o", "x.exr", "--udims=1001,1002")
        for words in vismap, one:
            self.refused(2, "udims: neither -o nor the name of an input holds <UDIM>", *words, "-o", "x.exr",
                         "--udims=1001")
            self.refused(2, 'udims: "1001-" is not a list of tiles', *words, "-o", "x.<UDIM>.exr", "--udims=1001-")
            self.refused(2, "udims: 1000 is no UDIM tile", *words, "-o", "x.<UDIM>.exr", "--udims=1000-1003")
            self.refused(2, "udim: 1000 is not in [1001, 9999]", *words, "-o", "x.exr", "--udim=1000")
            self.refused(2, "only one of udim and udims", *words, "-o", "x.<UDIM>.exr", "--udim=1001", "--udims=1001")
        self.refused(2, 'vismap: "vm.<UDIM>.exr": which tile?', *light, "-o", "x.exr")
        self.refused(2, 'environment: "sky.<UDIM>.exr": which tile?', "makecfem", "sky.<UDIM>.exr", "-o", "x.exr")
        self.refused(2, 'mesh: "hero.<UDIM>.obj": which tile?', "makevismap", "hero.<UDIM>.obj", "-o", "x.exr")
        self.refused(2, '"x.<UDIM>.exr": which tiles? No name of an input tells', *one, "-o", "x.<UDIM>.exr")
        self.refused(2, "all tiles would be the same picture", *one, "-o", "x.<UDIM>.exr", "--udims=1001,1002")
        for tool, words, key in (("makelightmap", ["gone.<UDIM>.exr", "sky.exr"], "vismap"),
                                 ("makecfem", ["gone.<UDIM>.exr"], "environment"),
                                 ("makevismap", ["gone.<UDIM>.exr"], "mesh")):
            self.refused(2, f'{key}: "gone.<UDIM>.exr": there is no such file for any tile', tool, *words, "-o",
                         "x.<UDIM>.exr")
        self.refused(2, '"hero.<UDIM>.lightmap": one recipe makes all tiles', "makelightmap", "hero.<UDIM>.lightmap",
                     "-o", "x.<UDIM>.exr")
        self.file("hero.vismap", 'mesh = "gone.<UDIM>.obj"\n')
        self.refused(1, 'mesh: "gone.<UDIM>.obj": there is no such file for any tile', "makelightmap",
                     "hero.vismap?udim=<UDIM>", "sky.exr", "-o", "x.<UDIM>.exr")
        self.refused(1, 'no folder "1001"', *light, "-o", "<UDIM>/x.exr")

    def test_a_tile_that_fails_is_named_and_those_before_it_stay(self):
        self.bake()
        self.file("vm.1002.exr", "no picture")
        result = self.run_tool("makelightmap", "vm.<UDIM>.exr", "sky.exr", "-o", "lit.<UDIM>.exr")
        self.assertEqual(result.returncode, 1)
        self.assertTrue(result.stderr.startswith('makelightmap ERROR: tile 1002: "vm.1002.exr": '), result.stderr)
        self.assertEqual(self.names("lit"), ["lit.1001.exr"])


class Recipes(Case):
    def bake(self):
        """The stages of a small light, by flags; and the flags of each."""
        self.file("quad.obj", QUAD)
        self.file("lid.obj", "v -9 -9 0.5\nv 1 -9 0.5\nv 1 9 0.5\nv -9 9 0.5\nf 1 2 3 4\n")
        self.vismap_words = ["quad.obj", "--occluder", "lid.obj", "--resolution", "16", "--samples", "16",
                             "--margin", "infinite"]
        self.cfem_words = [SKY, "--resolution", "32x16", "--colorconfig", CONFIG]
        self.light_words = ["vm.exr", "cfem.exr", "--rotate", "0,90,0.1", "--exposure", "-0.3"]
        self.done("makevismap", *self.vismap_words, "-o", "vm.exr")
        self.done("makecfem", *self.cfem_words, "-o", "cfem.exr")
        self.done("makelightmap", *self.light_words, "-o", "lit.exr")

    def test_a_recipe_makes_what_its_flags_make(self):
        self.bake()
        os.mkdir(self.path("recipes"))
        self.file("recipes/hero.vismap", 'mesh = "../quad.obj"\noccluder = ["../lid.obj"]\nresolution = 16\n'
                  'samples = 16\nmargin = "infinite"\n')
        self.file("recipes/studio.cfem", f'environment = "{SKY}"\nresolution = [32, 16]\ncolorconfig = "{CONFIG}"\n')
        self.file("recipes/hero.lightmap", 'vismap = "hero.vismap"\ncfem = "studio.cfem"\nrotate = [0, 90, 0.1]\n'
                  'exposure = -0.3\n')
        self.done("makevismap", "recipes/hero.vismap", "-o", "a.exr")
        self.done("makecfem", "recipes/studio.cfem", "-o", "b.exr")
        self.done("makelightmap", "recipes/hero.lightmap", "-o", "c.exr")
        self.assertEqual(self.read("a.exr"), self.read("vm.exr"))
        self.assertEqual(self.read("b.exr"), self.read("cfem.exr"))
        self.assertEqual(self.read("c.exr"), self.read("lit.exr"))
        # Recipes stand where images may, without a recipe around them too.
        self.done("makelightmap", "recipes/hero.vismap", "recipes/studio.cfem", *self.light_words[2:], "-o", "d.exr")
        self.assertEqual(self.read("d.exr"), self.read("lit.exr"))
        # A query alone says as much as a file.
        self.done("makelightmap", "x.lightmap?vismap=vm.exr&cfem=cfem.exr&rotate=0,90,0.1&exposure=-0.3", "-o", "e.exr")
        self.assertEqual(self.read("e.exr"), self.read("lit.exr"))

    def test_flags_override_the_query_which_overrides_the_file(self):
        self.bake()
        self.file("hero.lightmap", 'vismap = "vm.exr"\ncfem = "cfem.exr"\nrotate = [1, 2, 3]\nexposure = 5\n')
        self.done("makelightmap", "hero.lightmap?exposure=7&rotate=4,5,6", "-o", "a.exr", "--rotate", "0,90,0.1",
                  "--exposure=-0.3")
        self.assertEqual(self.read("a.exr"), self.read("lit.exr"))
        self.file("hero.vismap", 'mesh = "quad.obj"\noccluder = ["gone.obj"]\nresolution = 16\nsamples = 16\n'
                  'margin = "infinite"\n')
        self.done("makevismap", "--occluder", "lid.obj", "hero.vismap", "-o", "b.exr")
        self.assertEqual(self.read("b.exr"), self.read("vm.exr"))

    def test_a_printed_recipe_makes_the_same_image(self):
        self.bake()
        for tool, words, name, old in (("makevismap", self.vismap_words, "p.vismap", "vm.exr"),
                                       ("makecfem", self.cfem_words, "p.cfem", "cfem.exr"),
                                       ("makelightmap", self.light_words, "p.lightmap", "lit.exr")):
            before = self.contents()
            text = self.run_tool(tool, *words, "--print-recipe").stdout
            self.assertEqual(self.contents(), before)
            self.file(name, text)
            self.done(tool, name, "-o", "again.exr")
            self.assertEqual(self.read("again.exr"), self.read(old), text)
            self.assertEqual(self.run_tool(tool, name, "--print-recipe").stdout, text)
        self.assertEqual(text, 'vismap = "vm.exr"\ncfem = "cfem.exr"\nrotate = [0, 90, 0.1]\nexposure = -0.3\n')
        self.assertIn("environment = ", self.done("makelightmap", "vm.exr", SKY, "--print-recipe"))
        self.assertIn("cfem = ", self.done("makelightmap", "vm.exr", SKY, "--is-cfem", "--print-recipe"))
        self.refused(2, "a recipe holds neither --frames nor --rotate-y", "makelightmap", *self.light_words,
                     "--frames", "1-4", "--print-recipe")
        self.refused(2, "exposure: 99 is not in", "makelightmap", "vm.exr", SKY, "--exposure=99", "--print-recipe")

    def test_a_faulty_recipe_is_refused_with_its_line(self):
        self.file("bad.lightmap", 'vismap = "vm.exr"\nrotat = [0, 90, 0]\n')
        fault = '"bad.lightmap" line 2: unknown parameter "rotat"; did you mean "rotate"?'
        self.refused(1, fault, "makelightmap", "bad.lightmap", "-o", "x.exr")
        self.refused(1, "no such file", "makelightmap", "gone.lightmap", "-o", "x.exr")
        self.refused(2, '"more" is one argument too many', "makelightmap", "bad.lightmap", "more", "-o", "x.exr")
        self.file("noise.cfem", bytes(range(256)) * 16)
        self.file("empty.cfem")
        os.mkdir(self.path("folder.cfem"))
        for name in "noise.cfem", "empty.cfem", "folder.cfem":
            self.refused(1, f'"{name}"', "makecfem", name, "-o", "x.exr")
        self.refused(1, 'rotate: "abc" in "abc" is not a number', "makelightmap", "x.lightmap?rotate=abc", "-o", "x.exr")
        self.file("good.lightmap", "exposure = 1\n")
        self.refused(2, "exposure: 99 is not in", "makelightmap", "good.lightmap", "--exposure", "99", "-o", "x.exr")
        self.refused(2, "-o OUTPUT.exr is missing", "makelightmap", "good.lightmap")

    def test_a_missing_input_is_named_with_the_line_that_names_it(self):
        self.vismap()
        self.sky(1, 1, 1)
        self.file("a.lightmap", "exposure = 1\n")
        self.refused(1, '"a.lightmap": vismap is missing', "makelightmap", "a.lightmap", "-o", "x.exr")
        self.file("b.lightmap", 'vismap = "vm.exr"\n')
        self.refused(1, '"b.lightmap": environment is missing, or cfem', "makelightmap", "b.lightmap", "-o", "x.exr")
        self.file("c.lightmap", 'vismap = "vm.exr"\n\nenvironment = "gone.exr"\n')
        self.refused(1, '"c.lightmap" line 3: environment: "gone.exr": no such file', "makelightmap", "c.lightmap", "-o",
                     "x.exr")
        self.refused(1, 'ERROR: "other.exr": no such file', "makelightmap", "c.lightmap", "--environment", "other.exr",
                     "-o", "x.exr")
        self.file("d.lightmap", 'vismap = "vm.exr"\nenvironment = "sky.exr"\ncfem = "sky.exr"\n')
        self.refused(1, '"d.lightmap" line 3: cfem: environment is given too', "makelightmap", "d.lightmap", "-o",
                     "x.exr")
        self.done("makelightmap", "d.lightmap", "--environment=", "-o", "cleared.exr")
        self.file("e.vismap", 'mesh = "gone.obj"\n')
        self.file("e.lightmap", 'vismap = "e.vismap"\nenvironment = "sky.exr"\n')
        self.refused(1, '"e.lightmap" line 1: vismap: "e.vismap" line 1: mesh: "gone.obj": no such file',
                     "makelightmap", "e.lightmap", "-o", "x.exr")
        self.file("f.vismap", "samples = 1\n")
        self.refused(1, '"f.vismap": mesh is missing', "makevismap", "f.vismap", "-o", "x.exr")

    def test_an_input_of_the_wrong_stage_is_refused(self):
        self.bake()
        self.file("studio.cfem", 'environment = "sky.exr"\n')
        self.file("a.lightmap", 'vismap = "studio.cfem"\ncfem = "studio.cfem"\n')
        self.refused(1, '"a.lightmap" line 1: vismap: "studio.cfem": the recipe of a cfem, not of a vismap',
                     "makelightmap", "a.lightmap", "-o", "x.exr")
        self.file("b.lightmap", 'vismap = "vm.exr"\nenvironment = "studio.cfem"\n')
        self.refused(1, '"studio.cfem": the recipe of a cfem, not of an environment', "makelightmap", "b.lightmap", "-o",
                     "x.exr")
        self.file("c.lightmap", 'vismap = "vm.exr"\nenvironment = "cfem.exr"\n')
        self.refused(1, '"c.lightmap" line 2: environment: "cfem.exr": filtered already: give it as cfem',
                     "makelightmap", "c.lightmap", "-o", "x.exr")
        self.file("d.lightmap", 'vismap = "vm.exr"\ncfem = "lit.exr"\n')
        self.refused(1, '"lit.exr": neither an environment nor a CFEM', "makelightmap", "d.lightmap", "-o", "x.exr")

    def test_a_recipe_that_reads_itself_is_refused(self):
        self.bake()
        rest = 'vismap = "vm.exr"\ncfem = "cfem.exr"\n'
        self.file("self.lightmap", rest + 'albedo = "./self.lightmap"\n')
        self.refused(1, '"self.lightmap" line 3: albedo: "./self.lightmap" reads itself: "self.lightmap" -> '
                     '"./self.lightmap"', "makelightmap", "self.lightmap", "-o", "x.exr")
        self.file("a.lightmap", 'albedo = "b.lightmap"\n' + rest)
        self.file("b.lightmap", 'albedo = "a.lightmap"\n' + rest)
        self.refused(1, '"a.lightmap" reads itself: "a.lightmap" -> "b.lightmap" -> "a.lightmap"', "makelightmap",
                     "a.lightmap", "-o", "x.exr")
        self.file("self.cfem", 'environment = "self.cfem"\n')
        self.refused(1, '"self.cfem" reads itself', "makecfem", "self.cfem", "-o", "x.exr")
        # Not itself: the same file with another albedo.
        self.sky(0.5, 0.5, 0.5)
        self.file("twice.lightmap", rest + 'albedo = "twice.lightmap?albedo=sky.exr"\n')
        self.done("makelightmap", "twice.lightmap", "-o", "twice.exr")
        for link in range(70):
            self.file(f"{link}.lightmap", rest + f'albedo = "{link + 1}.lightmap"\n')
        self.refused(1, '"64.lightmap": more than 64 recipes, each within the last', "makelightmap", "0.lightmap", "-o",
                     "x.exr")

    def test_the_examples_work(self):
        examples = os.path.join(SOURCE, "configs/examples")
        self.done("makevismap", os.path.join(examples, "spot.vismap"), "-o", "vm.exr")
        self.done("makecfem", os.path.join(examples, "studio.cfem"), "-o", "cfem.exr")
        self.done("makelightmap", os.path.join(examples, "spot.lightmap"), "-o", "lit.exr")
        self.done("makelightmap", "vm.exr", "cfem.exr", "--rotate", "0,90,0", "--exposure", "-2.2", "-o", "expected.exr")
        self.assertEqual(self.read("lit.exr"), self.read("expected.exr"))


if __name__ == "__main__":
    unittest.main(argv=[sys.argv[0], *sys.argv[1:]])
