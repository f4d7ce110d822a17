# SPDX-License-Identifier: Apache-2.0
"""The executables as a user meets them: what they refuse, how, and what they leave behind.

Run as: cli_test.py [CASE ...], with VMLIGHT_BIN (the executables' folder), VMLIGHT_SOURCE (the repository) and oiiotool
on the path. Each TestCase is one CTest test.
"""
import os
import pty
import resource
import signal
import struct
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
        self.refused(1, "the model ao needs what makevismap --channels normal bakes", "makelightmap", "vm.exr",
                     *words)
        self.assertFalse(os.path.exists(self.path("lit.exr")))
        self.done("makevismap", SPOT, "-o", "vmn.exr", "--resolution", "64", "--samples", "16", "--channels", "normal")
        self.done("makelightmap", "vmn.exr", *words)
        self.file("n.vismap", f'mesh = "{SPOT}"\nresolution = 64\nsamples = 16\nchannels = ["normal"]\n')
        self.done("makelightmap", "n.vismap", *words[:-1], "live.exr")
        self.assertEqual(self.read("live.exr"), self.read("lit.exr"))
        self.done("makelightmap", "vmn.exr", "cfem.exr", "-o", "a.exr")
        self.done("makelightmap", "vm.exr", "cfem.exr", "-o", "b.exr")
        self.assert_same_pixels("a.exr", "b.exr", 0)

    def test_a_basis_lights_by_the_model_of_its_name(self):
        self.done("makecfem", SKY, "--stack", "-o", "stack.exr")
        for basis, channels, floats in (("sh", "sh.24", 25), ("mask", "mask.10", 18), ("cells", "cells.11", 19)):
            words = os.path.join(SOURCE, "tests/data/gazebo.obj"), "--resolution", "64", "--samples", "32", "--basis", basis
            self.done("makevismap", *words, "-o", basis + ".exr")
            info = self.oiiotool("--info", "-v", basis + ".exr")
            self.assertIn(channels, info)
            self.assertIn(f"{floats} channel", info)
            told = self.done("makelightmap", basis + ".exr", "stack.exr", "--rotate", "0,30,0", "-o", "a.exr")
            self.assertIn(f"model: {basis}, the best that the visibility map is fit for", told)
            told = self.done("makelightmap", basis + ".exr", SKY, "--rotate", "0,30,0", "-o", "b.exr")
            self.assertIn("reduce: 512x256 to 128x64", told)  # no lobe is filtered that is not looked up
            self.assertNotIn("filter:", told)
            self.assertEqual(self.read("a.exr"), self.read("b.exr"))
            # Live, from recipes: the same bytes.
            self.file(basis + ".vismap", self.done("makevismap", *words, "--print-recipe").encode())
            self.file("x.lightmap", self.done("makelightmap", basis + ".vismap", SKY, "--rotate", "0,30,0",
                                              "--print-recipe").encode())
            self.done("makelightmap", "x.lightmap", "-o", "c.exr")
            self.assertEqual(self.read("a.exr"), self.read("c.exr"))
            if basis == "sh":
                self.done("makevismap", *words, "--order", "3", "--format", "half", "-o", "half.exr")
                self.done("makelightmap", "half.exr", "stack.exr", "-o", "x.exr")
            else:
                self.refused(2, f"--format half: the basis {basis} holds whole numbers that half floats do not keep",
                             "makevismap", *words, "--format", "half", "-o", "half.exr")
            self.oiiotool(basis + ".exr", "--resize", "32x32", "-o", "small.exr")
            if basis != "sh":
                self.refused(1, "whole numbers below 2^24 any more", "makelightmap", "small.exr", "stack.exr", "-o",
                             "x.exr")
            info = self.oiiotool("--info", "-v", "b.exr")  # and no word of a filter that was not used
            self.assertIn("vmlight:cfem_resolution", info)
            self.assertNotIn("vmlight:cfem_filter", info)
            for flag, value in ("--cfem-filter", "sh"), ("--cfem-order", "4"):
                self.refused(2, f"the model {basis} reads the environment unfiltered", "makelightmap", basis + ".exr",
                             SKY, "--model", basis, flag, value, "-o", "x2.exr")
        self.refused(2, "only the basis sh has bands", "makevismap", SPOT, "--order", "4", "-o", "x.exr")
        self.refused(1, "basis: mask goes with the measure cosine, not with uniform", "makevismap", SPOT, "--basis",
                     "mask", "--measure", "uniform", "-o", "x.exr")

    def test_a_stack_lights_by_lobes(self):
        self.vismap()
        self.done("makecfem", SKY, "-o", "cfem.exr")
        self.assertIn("to 10 of 128x64", self.done("makecfem", SKY, "--stack", "-o", "stack.exr"))
        self.assertIn("model: lobe, the best that the visibility map is fit for", self.done("makelightmap", "vm.exr", "stack.exr", "-o",
                                                                          "stack_lit.exr"))
        self.assertIn("model: lobe, the best that the visibility map is fit for",
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
        # Little-endian PFM, bottom row first; OIIO 3.1 takes it for the top one.
        flipped = b"".join(rows[i:i + 96] for i in range(0, len(rows), 96))
        self.file("bad.pfm", b"PF\n8 4\n-1.0\n" + flipped)
        self.refused(1, "environment has 3 values that are NaN, infinite or negative, the first at pixel (2, ",
                     "makecfem", "bad.pfm", "-o", "x.exr")
        out = self.done("makecfem", "bad.pfm", "-o", "x.exr", "--sanitize")
        self.assertIn("3 bad values of the environment were mended", out)
        self.assertNotIn("nan", self.oiiotool("x.exr", "--printstats").lower().replace("nancount: 0", ""))


if __name__ == "__main__":
    unittest.main(argv=[sys.argv[0], *sys.argv[1:]])
