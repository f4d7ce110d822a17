# SPDX-License-Identifier: Apache-2.0
"""The executables as a user meets them: what they refuse, how, and what they leave behind.

Run as: cli_test.py [CASE ...], with VMLIGHT_BIN (the executables' folder), VMLIGHT_SOURCE (the repository) and oiiotool
on the path. Each TestCase is one CTest test.
"""
import os
import pty
import resource
import signal
import subprocess
import sys
import time
import unittest

from case import BIN, CONFIG, QUAD, QUAD_WITHOUT_UV, SKY, SOURCE, SPOT, Case


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
            self.assertIn("Usage: " + tool, self.done(tool, "-o", "", "--help"))

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
                ("--samples", "", "--samples has an empty value"),
                ("--occluder", " ", "--occluder has an empty value"),
                ("--resolution", "0", 'resolution: "0" is not WIDTHxHEIGHT from 1x1 to 32768x32768'),
                ("--resolution", "99999", "resolution:"),
                ("--sampler", "random", 'sampler: "random" is not one of fibonacci, sobol, halton'),
                ("--max-distance", "far", 'max_distance: "far" is not a number or "infinite"'),
                ("--max-distance", "nan", 'max_distance: "nan" is not a number'),
                ("--max-distance", "-1", "max_distance: -1 is not in [0, 1e+30] or \"infinite\""),
                ("--margin", "-2", "margin: -2 is not in"),
                ("--channels", "normals", 'channels: "normals" is not one of normal, coverage, error; did you mean "normal"?'),
                ("--channels", "normal,normal", 'channels: "normal" comes twice'),
                ("--format", "double", 'format: "double" is not one of float, half'),
                ("--threads", "-1", "threads: -1 is not in [0, 1024]"),
                ("--uv-set", "8", "uv_set: 8 is not in [0, 7]")]:
            self.refused(2, text, "makevismap", "quad.obj", "-o", "x.exr", flag, value)
            self.refused(2, text, "makevismap", "quad.obj", "-o", "x.exr", flag + "=" + value)
        self.refused(2, "--quiet takes no value", "makevismap", "quad.obj", "-o", "x.exr", "--quiet=1")

    def test_values_may_begin_with_a_minus_or_follow_an_equals_sign(self):
        self.done("makelightmap", "vm.exr", "sky.exr", "-o", "a.exr", "--rotate", "-90,0,0", "--exposure", "-1")
        self.done("makelightmap", "vm.exr", "sky.exr", "-o=b.exr", "--rotate=-90,0,0", "--exposure=-1")
        self.assertEqual(self.read("a.exr"), self.read("b.exr"))

    def test_frames_are_refused_in_words(self):
        lightmap = ["makelightmap", "vm.exr", "sky.exr"]
        self.refused(2, "is not a range of frames", *lightmap, "-o", "x.#.exr", "--frames", "1-x")
        self.refused(2, "--frames has an empty value", *lightmap, "-o", "x.#.exr", "--frames", "")
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
                            ("--vismap has an empty value", ["--vismap", ""]),
                            ("--environment has an empty value", ["--environment", ""])):
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
                ("--samples 8: target_error says how many", [*bake, "--samples", "8", "--target-error", "0.1"]),
                ("--samples 8: time_budget says how many", [*bake, "--time-budget=1", "--samples", "8"]),
                ("--time-budget 1: target_error says how many", [*bake, "--time-budget=1", "--target-error=0.1"]),
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
        try:
            ours, theirs = pty.openpty()
        except OSError:
            self.skipTest("no terminals here: a bare root without /dev/pts")
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


if __name__ == "__main__":
    unittest.main(argv=[sys.argv[0], *sys.argv[1:]])
