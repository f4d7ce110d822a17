# SPDX-License-Identifier: Apache-2.0
"""What takes processes: the executables themselves, signals, and terminals. (All else that a command line may say is in
the C++ tests beside this file, which run hundreds of them in one process.)

Run as: process_test.py [CASE ...], with VMLIGHT_BIN (the executables' folder) and VMLIGHT_SOURCE (the repository). Each
TestCase is one CTest test.
"""
import json
import os
import pty
import re
import signal
import subprocess
import sys
import time
import unittest

from case import BIN, QUAD, SKY, SPOT, Case


class Executables(Case):
    def test_each_runs_and_returns_its_exit_codes(self):
        self.vismap()
        self.done("makecfem", SKY, "-o", "cfem.exr", "--quiet")
        self.assertIn("model: paper", self.done("makelightmap", "vm.exr", "cfem.exr", "-o", "lit.exr"))
        self.done("vmcost", "quad.obj", SKY, "-o", "report", "--quick", "--resolution", "16", "--reference-samples", "8",
                  "--no-plots")
        before = self.contents()
        for tool, operands in (("makevismap", ["quad.obj"]), ("makecfem", [SKY]), ("makelightmap", ["vm.exr", "cfem.exr"]),
                               ("vmcost", ["quad.obj", SKY])):
            self.assertRegex(self.done(tool, "--version"), r"\d+\.\d+\.\d+")
            self.refused(2, 'unknown flag "--nonsense"', tool, *operands, "-o", "x.exr", "--nonsense")
            self.refused(1, '"gone": no such file', tool, *operands[:-1], "gone", "-o", "x.exr")
        self.assertEqual(self.contents(), before)


class Signals(Case):
    def setUp(self):
        super().setUp()
        self.file("old.exr", "the old picture")

    def test_an_interrupt_leaves_the_old_file_and_no_debris(self):
        before = self.contents()
        for number in signal.SIGINT, signal.SIGTERM, signal.SIGHUP:
            process = subprocess.Popen([os.path.join(BIN, "makevismap"), SPOT, "-o", "old.exr", "--resolution", "4096",
                                        "--samples", "65536"], cwd=self.folder, stderr=subprocess.PIPE, text=True)
            line = process.stderr.readline()  # the bake is under way
            process.send_signal(number)
            _, rest = process.communicate(timeout=300)
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
        _, rest = process.communicate(timeout=300)
        self.assertEqual((process.returncode, rest), (1, "makevismap ERROR: interrupted\n"))
        self.assertEqual(self.contents(), before)

    def test_progress_shows_share_rate_and_time_left(self):
        words = [os.path.join(BIN, "makevismap"), SPOT, "-o", "x.exr", "--resolution", "256", "--samples", "512",
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
        self.assertEqual(process.wait(timeout=300), 0, shown)
        line = rb" %  [\d.]+ [kMG]? ?texels/s  \d\d:\d\d"
        self.assertRegex(shown, rb"\rbake +\d+" + line + b" left *\r")
        self.assertRegex(shown, rb"\rbake 100" + line + b" *\r\n")
        # In a file: a line for each tenth, and no carriage return.
        lines = self.run_tool(*words).stderr
        self.assertRegex(lines, r"(?m)^bake +\d+ %  [\d.]+ k texels/s  \d\d:\d\d left$")
        self.assertLessEqual(len(re.findall(r"(?m)^bake +\d+ %", lines)), 11)  # tenths 0 to 10
        self.assertNotIn("\r", lines)


class KilledBakes(Case):
    WORDS = ["makevismap", SPOT, "--resolution", "320", "--samples", "192", "--threads", "1", "--quiet"]

    def killed(self, number, kept, *words):
        """Ends a bake once `kept` parts are there, more than before."""
        process = subprocess.Popen([os.path.join(BIN, self.WORDS[0]), *self.WORDS[1:], *words], cwd=self.folder,
                                   stderr=subprocess.PIPE, text=True)
        until = time.monotonic() + 300
        while len(os.listdir(self.folder)) < kept and process.poll() is None:
            self.assertLess(time.monotonic(), until)
            time.sleep(0.001)
        process.send_signal(number)
        _, error = process.communicate(timeout=300)
        return process.returncode, error

    def test_parts_that_are_whole_are_kept_and_nothing_else(self):
        self.done(*self.WORDS, "-o", "whole.exr")
        whole = self.read("whole.exr")
        os.remove(self.path("whole.exr"))
        for kept in 1, 5, 14:
            self.assertEqual(self.killed(signal.SIGKILL, kept, "-o", "vm.exr", "--resume"), (-signal.SIGKILL, ""))
            names = sorted(os.listdir(self.folder))
            self.assertGreaterEqual(len(names), kept)
            self.assertEqual(names, [f"vm.resume{index + 1:02}of25.exr" for index in range(len(names))])
        old = {name: os.stat(self.path(name)).st_mtime_ns for name in names}
        self.assertEqual(self.killed(signal.SIGTERM, len(old) + 2, "-o", "vm.exr", "--resume"),
                         (1, "makevismap ERROR: interrupted\n"))
        for name, written in old.items():
            self.assertEqual(os.stat(self.path(name)).st_mtime_ns, written, name)
        self.done(*self.WORDS, "-o", "vm.exr", "--resume")
        self.assertEqual(os.listdir(self.folder), ["vm.exr"])
        self.assertEqual(self.read("vm.exr"), whole)


class CostCutShort(Case):
    WORDS = ["vmcost", SPOT, SKY, "-o", "report", "--quick", "--resolution", "64", "--reference-samples", "16",
             "--no-plots"]

    def interrupted(self, number):
        process = subprocess.Popen([os.path.join(BIN, self.WORDS[0]), *self.WORDS[1:], "--quiet"], cwd=self.folder,
                                   stderr=subprocess.PIPE, text=True)
        journal = self.path("report/journal.jsonl")
        until = time.monotonic() + 300
        while not (os.path.exists(journal) and os.path.getsize(journal) > 1000):
            self.assertIsNone(process.poll())
            self.assertLess(time.monotonic(), until)
            time.sleep(0.01)
        process.send_signal(number)
        sent = time.monotonic()
        _, error = process.communicate(timeout=300)
        self.assertLess(time.monotonic() - sent, 10)  # at once, on a machine that may be busy
        return process.returncode, error

    def test_a_run_that_is_cut_short_goes_on_where_it_stopped(self):
        code, error = self.interrupted(signal.SIGINT)
        self.assertEqual((code, error), (1, "vmcost ERROR: interrupted\n"))
        names = os.listdir(self.path("report"))
        self.assertFalse([name for name in names if name.startswith(".")], "debris")
        kept = self.read("report/journal.jsonl").count(b"\n")
        self.assertGreaterEqual(kept, 2)
        code, _ = self.interrupted(signal.SIGKILL)
        self.assertEqual(code, -signal.SIGKILL)
        with open(self.path("report/journal.jsonl"), "ab") as journal:
            journal.write(b'{"key": "torn", "environment": "che')
        out = self.done(*self.WORDS)
        self.assertIn("studio_small_03: reused the reference", out)
        measured, reused = map(int, re.search(r"measured (\d+) rows?, reused (\d+)", out).groups())
        self.assertGreaterEqual(reused, kept)
        self.assertGreater(measured, 0)
        with open(self.path("report/costs.json")) as file:
            self.assertEqual(measured + reused, len(json.load(file)["rows"]))


if __name__ == "__main__":
    unittest.main(argv=[sys.argv[0], *sys.argv[1:]])
