# SPDX-License-Identifier: Apache-2.0
"""Hard machines: full, small, without what a process usually finds. (machine_test.cpp kills and crowds.)"""
import os
import resource
import shutil
import subprocess
import sys
import unittest

from hard_machine import BIN, LIMIT, QUAD, SKY, SMALL, SPOT, HardCase


class Machine(HardCase):
    BAKE = ["makevismap", SPOT, "--resolution", "384", "--samples", "4", "--quiet"]

    def setUp(self):
        super().setUp()
        self.file("quad.obj", QUAD)

    def start(self, *words, **options):
        return subprocess.Popen([os.path.join(BIN, words[0]), *words[1:]], cwd=self.folder, env=self.environment,
                                stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, text=True, **options)

    def test_target_moves_away(self):
        os.mkdir(self.path("out"))
        process = self.start("makevismap", SPOT, "--resolution", "512", "--samples", "512", "-o", "out/x.exr")
        process.stderr.readline()  # the bake is under way
        shutil.rmtree(self.path("out"))
        _, told = process.communicate(timeout=LIMIT)
        self.assertEqual(process.returncode, 1, told)
        self.assertIn('makevismap ERROR: "out/x.exr": no such folder: "out"', told)
        self.row("The output folder is removed during the bake", "exit code 0 without a file",
                 "exit code 1: no such folder")

    def test_full_disk(self):
        script = """mount -t tmpfs -o size=64k tmpfs out || exit 77
            echo old > out/x.exr
            "$@"
            code=$?
            ls -A out; cat out/x.exr
            exit $code"""
        os.mkdir(self.path("out"))
        flags = ["-rm"] if os.geteuid() else ["-m"]
        for words in (["makevismap", SPOT, "--resolution", "256", "--samples", "4"],
                      ["makecfem", SKY, "--resolution", "256", "--stack"],
                      ["makevismap", SPOT, "--resolution", "256", "--samples", "4", "--threads", "1"]):
            words = [os.path.join(BIN, words[0]), *words[1:], "--quiet", "-o", "out/x.exr"]
            result = subprocess.run(["unshare", *flags, "sh", "-c", script, "sh", *words], cwd=self.folder,
                                    capture_output=True, text=True, timeout=LIMIT)
            if result.returncode == 77 or "unshare" in result.stderr:
                self.skip("this host lets no file system be mounted: " + result.stderr.strip())
            self.assertEqual((result.returncode, result.stdout), (1, "x.exr\nold\n"), result.stderr)
            self.assertIn('ERROR: "out/x.exr": ', result.stderr)
            self.assertIn("No space left on device", result.stderr)
        self.row("The disk is full", "a truncated file in place of the old one; OpenEXR's writing threads hang",
                 "exit code 1 with the reason; the old file is untouched")

    def test_limit_of_file_size(self):
        def limit():
            resource.setrlimit(resource.RLIMIT_FSIZE, (100000, 100000))
        self.file("x.exr", "old")
        before = self.contents()
        result = self.run_tool(*self.BAKE, "-o", "x.exr", preexec_fn=limit)
        self.told(result, 1, 'makevismap ERROR: "x.exr": File too large')
        self.assertEqual(self.contents(), before)
        self.row("The output exceeds `ulimit -f`", "SIGXFSZ ends the process without a message",
                 "exit code 1 with the reason; the old file is untouched")

    def test_more_memory_than_there_is(self):
        before = self.contents()
        # The margin of all texels needs the whole map.
        whole = ["makevismap", "quad.obj", "--resolution", "32768", "--margin", "infinite", "--reconstruct", "off"]
        for words, text in (
                (["--basis", "sh", "--order", "8"], "32768x32768 pixels of 64 channels need 256.0 GB of memory, "),
                (["--channels", "normal,coverage,error", "--basis=sh"],
                 "32768x32768 pixels of 30 channels need 120.0 GB of memory, ")):
            with open("/proc/meminfo") as info:
                if int(info.readline().split()[1]) > 100 << 20:
                    self.skip("a machine that may have the memory")
            self.told(self.run_tool(*whole, *words, "-o", "x.exr"), 1, text)
        self.file("wide.vismap", 'mesh = "quad.obj"\nresolution = 32768\nbasis = "sh"\norder = 8\nmargin = "infinite"\nreconstruct = "off"\n')
        code, told = self.reader("wide.vismap")
        self.assertEqual(code, 1)
        self.assertTrue("256.0 GB of memory, " in told, told[:500])
        os.remove(self.path("wide.vismap"))
        self.assertEqual(self.contents(), before)
        self.row("A map of 256 GB", "the system grants the memory and kills the process that fills it",
                 "exit code 1 before the bake, with the memory needed and available")

    def test_limit_of_memory(self):
        def limit():
            resource.setrlimit(resource.RLIMIT_AS, (1 << 30, 1 << 30))
        if os.environ.get("VMLIGHT_PRELOAD"):
            self.skip("sanitizers take all addresses there are")
        # How many arenas malloc keeps addresses for, 64 MB each, depends on how busy the machine is.
        limits = dict(preexec_fn=limit, env={**self.environment, "MALLOC_ARENA_MAX": "1"})
        self.file("x.exr", "old")
        before = self.contents()
        words = ["makevismap", "quad.obj", "-o", "x.exr", "--quiet", "--margin", "infinite"]
        self.told(self.run_tool(*words, "--samples", "1", "--resolution", "16384x4096", **limits), 1,
                  "16384x4096 pixels of 4 channels need 1.0 GB of memory, ")
        # What reconstruction needs besides can be left out.
        result = self.run_tool(*words, "--resolution", "4096", **limits)
        self.told(result, 1, "4096x4096 pixels of 4 channels need 1.1 GB of memory, ")
        self.assertIn("; with --reconstruct off it fits", result.stderr)
        # A part is some rows of it, whatever its margin will be.
        result = self.run_tool(*words, "--samples", "1", "--resolution", "16384x4096", "--part", "1/64", **limits)
        self.assertEqual(result.returncode, 0, result.stderr)
        os.remove(self.path("x.part01of64.exr"))
        # With a narrow margin the map is written while it is baked.
        words = words[:-2]
        result = self.run_tool(*words, "--resolution", "32768x1024", "--basis=sh", "--order=8", **limits)
        self.told(result, 1, "rows of 32768 texels of 64 channels need ")
        self.assertEqual(self.contents(), before)
        result = self.run_tool(*words, "--resolution", "4096", **limits)
        self.assertEqual(result.returncode, 0, result.stderr)
        result = self.run_tool(*words, "--samples", "1", "--resolution", "2048", **limits)
        self.assertEqual(result.returncode, 0, result.stderr)
        self.row("A map that exceeds `ulimit -v`", "std::bad_alloc, or an image without pixels",
                 "exit code 1, with the memory needed and available; smaller maps work, and larger ones that are written while "
                 "they are baked")

    def test_no_streams(self):
        # Else the output would be the process's stdout, and what it says would go into the picture.
        # It takes a busy machine a while to get to main().
        script = ('"$@" <&- >&- 2>&- & open=0; while [ $open != 3 ] && kill -0 $!; do sleep .1; '
                  'open=$(ls -l /proc/$!/fd | grep -c " [012] ->"); done; echo $open; kill $!')
        words = [os.path.join(BIN, "makevismap"), SPOT, "--resolution", "4096", "--samples", "65536", "-o", "x.exr"]
        result = subprocess.run(["sh", "-c", script, "sh", *words], cwd=self.folder, capture_output=True, text=True,
                                timeout=LIMIT)
        self.assertEqual(result.stdout.split()[-1], "3", "what is opened next is taken for a closed stream")
        self.done("makevismap", SPOT, "-o", "y.exr", "--resolution", "64", "--samples", "4", "--quiet")
        for shut in "<&-", ">&-", "2>&-", "<&- >&- 2>&-", ">/dev/full", "2>/dev/full", ">/dev/full 2>/dev/full":
            result = subprocess.run(["sh", "-c", '"$@" ' + shut, "sh", os.path.join(BIN, "makevismap"), SPOT, "-o",
                                     "x.exr", "--resolution", "64", "--samples", "4"], cwd=self.folder,
                                    capture_output=True, timeout=LIMIT)
            self.assertEqual(result.returncode, 0, shut)
            self.assertEqual(self.read("x.exr"), self.read("y.exr"), shut)
        result = subprocess.run(["sh", "-c", '"$@" >/dev/full', "sh", os.path.join(BIN, "makevismap"), "quad.obj",
                                 "--print-recipe"], cwd=self.folder, capture_output=True, text=True, timeout=LIMIT)
        self.told(result, 1, "cannot write to stdout")
        self.row("stdin, stdout and stderr closed, or redirected to a full disk",
                 "the image gets the descriptor of stdout, and messages are written into it", "the same image, exit code 0")

    def test_listener_leaves(self):
        ours, theirs = os.pipe()
        os.close(ours)
        result = self.run_tool("makevismap", "quad.obj", "-o", "x.exr", "--resolution", "16", capture_output=False,
                               stdout=theirs, stderr=theirs)
        os.close(theirs)
        self.assertEqual(result.returncode, 0)
        self.assert_finite("x.exr")
        self.row("The reader of stdout and stderr has exited (`| head -1`)", "SIGPIPE ends the bake",
                 "the image, exit code 0")

    def test_bare_environment(self):
        self.done("makevismap", SPOT, "-o", "a.exr", *SMALL)
        kept = {name: value for name, value in os.environ.items() if name in ("LD_LIBRARY_PATH", "ASAN_OPTIONS")}
        for environment in kept, dict(kept, LANG="C", LC_ALL="C"), dict(kept, LC_ALL="de_DE.UTF-8", HOME="/nowhere",
                                                                       TMPDIR="/nowhere"):
            result = self.run_tool("makevismap", SPOT, "-o", "b.exr", *SMALL, env=environment)
            self.assertEqual(result.returncode, 0, result.stderr)
            self.assertEqual(self.read("a.exr"), self.read("b.exr"))
        self.row("No HOME, TMPDIR or PATH; LANG is C, or a locale with decimal commas",
                 "numbers are read and written with the locale", "the same bytes")

    def test_few_files_many_threads(self):
        def limit():
            resource.setrlimit(resource.RLIMIT_NOFILE, (16, 16))
        self.done(*self.BAKE, "-o", "a.exr")
        for threads in "1", "1000":
            result = self.run_tool(*self.BAKE, "-o", "b.exr", "--threads", threads, preexec_fn=limit)
            self.assertEqual(result.returncode, 0, result.stderr)
            self.assertEqual(self.read("a.exr"), self.read("b.exr"))
        self.sky(1, 2, 3, size="4x2")
        for udim in range(1001, 1031):
            shutil.copy(self.path("sky.exr"), self.path(f"sky.{udim}.exr"))
        self.assertEqual(self.run_tool("makecfem", "sky.<UDIM>.exr", "-o", "cfem.<UDIM>.exr", "--resolution", "4",
                                       preexec_fn=limit).returncode, 0)
        self.row("At most 16 open files (`ulimit -n`), with 30 tiles and with 1000 threads",
                 "files that stay open exhaust the limit at the 14th", "the same bytes")


if __name__ == "__main__":
    unittest.main(argv=[sys.argv[0], *sys.argv[1:]])
