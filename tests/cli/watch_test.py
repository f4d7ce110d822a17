# SPDX-License-Identifier: Apache-2.0
"""makelightmap --watch: each change gives the bytes of a fresh makelightmap, uncompressed, and one line.

Run as: watch_test.py, with VMLIGHT_BIN (the executables' folder) and VMLIGHT_SOURCE (the repository)."""
import os
import queue
import shutil
import signal
import subprocess
import sys
import threading
import unittest

from case import BIN, SKY, SPOT, Case

UNCOMPRESSED = "--compression", "none"  # as is written by default
LONGEST = 300  # seconds to wait for what comes at once


def hand_on(stream, lines):
    """Each line as it comes, and "" at the end."""
    for line in stream:
        lines.put(line)
    lines.put("")


class Watched(Case):
    made = {}  # files that each test begins with, made once

    def setUp(self):
        super().setUp()
        if not sys.platform.startswith("linux"):
            self.skipTest("files can be watched on Linux only")
        self.process = None
        if not self.made:
            self.vismap()
            self.sky(1, 2, 3)
            self.made.update({name: self.read(name) for name in os.listdir(self.folder)})
        for name, content in self.made.items():
            self.file(name, content)
        os.mkdir(self.path("out"))
        self.recipe()

    def tearDown(self):
        if self.process:
            self.process.kill()
            self.ended()
        super().tearDown()

    def ended(self):
        """The exit code, once all that was said is here."""
        code = self.process.wait(timeout=LONGEST)
        for reader in self.readers:
            reader.join()
        for stream in self.lines:
            stream.close()
        return code

    def recipe(self, lines="", folder=""):
        self.file(folder + "hero.lightmap", f'vismap = "vm.exr"\nenvironment = "sky.exr"\n{lines}\n')

    def replace(self, name, source):
        """As editors do: a new file takes the place."""
        shutil.copy(self.path(source), self.path(name + ".new"))
        os.replace(self.path(name + ".new"), self.path(name))

    def start(self, *words):
        self.process = subprocess.Popen([os.path.join(BIN, "makelightmap"), *words, "--watch"], cwd=self.folder,
                                        env=self.environment, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)
        self.lines = {self.process.stdout: queue.Queue(), self.process.stderr: queue.Queue()}
        self.readers = [threading.Thread(target=hand_on, args=pair) for pair in self.lines.items()]
        for reader in self.readers:
            reader.start()
        if "--quiet" not in words:
            self.said("watched; Ctrl-C ends")

    def next_line(self, stream="stdout"):
        return self.lines[getattr(self.process, stream)].get(timeout=LONGEST)

    def said(self, text):
        """Lines up to one that has the text."""
        lines = []
        while text not in (lines[-1] if lines else ""):
            line = self.next_line()
            self.assertTrue(line, (text, lines))
            lines.append(line)
        return lines

    def made_anew(self, *changed, words=("hero.lightmap",), output="out/lit.exr"):
        """The next line names the files, and the image is that of a fresh process."""
        self.assertRegex(self.next_line(), "^watch: " + ", ".join(changed) + f" changed: {output} in \\d+ ms\n$")
        self.done("makelightmap", *(() if "--compression" in words else UNCOMPRESSED), *words, "-o", "fresh.exr", "--quiet")
        self.assertEqual(self.read(output), self.read("fresh.exr"), changed)

    def test_each_input_is_followed_however_it_is_replaced(self):
        self.recipe('albedo = "paint.exr"')
        self.sky(0.5, 0.25, 1, size="32x32", name="paint.exr")
        self.start("hero.lightmap", "-o", "out/lit.exr")
        first = self.read("out/lit.exr")
        self.recipe('albedo = "paint.exr"\nrotate = [0, 90, 0]')  # written in place
        self.made_anew("hero.lightmap")
        self.sky(3, 2, 1, name="other.exr")
        self.replace("sky.exr", "other.exr")
        self.made_anew("sky.exr")
        self.sky(1, 1, 1, size="32x32", name="other.exr")
        self.replace("paint.exr", "other.exr")
        self.made_anew("paint.exr")
        self.done("makevismap", "quad.obj", "-o", "vm2.exr", "--resolution", "16", "--samples", "4", "--quiet")
        self.sky(1, 1, 0, size="16x16", name="other.exr")
        os.kill(self.process.pid, signal.SIGSTOP)  # two changes at once
        self.replace("vm.exr", "vm2.exr")
        self.replace("paint.exr", "other.exr")
        os.kill(self.process.pid, signal.SIGCONT)
        self.made_anew("paint.exr", "vm.exr")
        self.assertNotEqual(self.read("out/lit.exr"), first)

    def test_flags_stay_and_recipes_of_recipes_are_followed(self):
        self.file("sky.cfem", 'environment = "sky.exr"\n')
        self.file("hero.lightmap", 'vismap = "vm.exr"\ncfem = "sky.cfem"\n')
        words = "hero.lightmap", "--exposure", "1", "--format", "half", "--compression", "zip"
        self.start(*words, "-o", "out/lit.exr")
        self.file("sky.cfem", 'environment = "sky.exr"\nresolution = "16x8"\n')
        self.made_anew("sky.cfem", words=words)
        self.sky(5, 5, 5, name="sky.exr")
        self.made_anew("sky.exr", words=words)

    def test_an_ocio_config_is_followed(self):
        config = os.path.join(os.environ["VMLIGHT_SOURCE"], "configs/ocio/config.ocio")
        shutil.copy(config, self.path("config.ocio"))
        words = "vm.exr", "sky.exr", "--colorconfig", "config.ocio", "--colorspace", "lin_rec709_scene"
        result = self.run_tool("makelightmap", *words, "-o", "fresh.exr")
        if result.returncode != 0:
            self.skipTest("the config has no such space: " + result.stderr)
        self.start(*words, "-o", "out/lit.exr")
        first = self.read("out/lit.exr")
        self.file("config.ocio", self.read("config.ocio").replace(b"scene_linear: ACEScg", b"scene_linear: ACES2065-1"))
        self.made_anew("config.ocio", words=words)
        self.assertNotEqual(self.read("out/lit.exr"), first)

    def test_a_turn_reads_no_image_again(self):
        self.done("makevismap", SPOT, "-o", "vm.exr", "--resolution", "256", "--samples", "4", "--quiet")
        shutil.copy(SKY, self.path("sky.exr"))  # a Radiance file, as its content says
        self.start("hero.lightmap", "-o", "out/lit.exr")

        def read_so_far():
            with open(f"/proc/{self.process.pid}/io") as file:
                return int(file.readline().split()[1])
        before = read_so_far()
        for angle in 30, 60, 90:
            self.recipe(f"rotate = [0, {angle}, 0]")
            self.assertIn("watch: hero.lightmap changed", self.next_line())
        self.assertLess(read_so_far() - before, min(os.path.getsize(self.path(name)) for name in ("vm.exr", "sky.exr")) / 2)
        self.done("makelightmap", "hero.lightmap", "-o", "fresh.exr", "--quiet", *UNCOMPRESSED)
        self.assertEqual(self.read("out/lit.exr"), self.read("fresh.exr"))

    def test_a_fault_is_told_once_and_keeps_the_image(self):
        self.start("hero.lightmap", "-o", "out/lit.exr")
        good = self.read("out/lit.exr")
        whole = self.read("sky.exr")
        self.file("sky.exr", whole[:len(whole) // 2])
        self.assertIn("makelightmap ERROR: ", self.next_line("stderr"))
        self.assertEqual(self.next_line("stderr"), "makelightmap: the image stays as it was, until a file changes again\n")
        self.assertEqual(self.read("out/lit.exr"), good)
        self.recipe("rotates = 1")
        self.assertIn('unknown parameter "rotates"; did you mean "rotate"?', self.next_line("stderr"))
        self.next_line("stderr")
        self.file("sky.exr", whole)
        self.recipe("exposure = 1")
        self.made_anew("hero.lightmap")
        self.assertNotEqual(self.read("out/lit.exr"), good)
        self.assertEqual(sorted(os.listdir(self.path("out"))), ["lit.exr"])

    def test_a_burst_of_changes_gives_one_image(self):
        self.start("hero.lightmap", "-o", "lit.exr")  # in the folder that is watched
        os.kill(self.process.pid, signal.SIGSTOP)
        for angle in range(100):
            self.recipe(f"rotate = [0, {angle}, 0]")
        os.kill(self.process.pid, signal.SIGCONT)
        self.made_anew("hero.lightmap", output="lit.exr")
        self.sky(4, 4, 4)  # whose line is the next
        self.made_anew("sky.exr", output="lit.exr")

    def test_folders_and_links_may_go_and_come_back(self):
        os.makedirs(self.path("show/v1"))
        os.makedirs(self.path("show/v2"))
        shutil.copy(self.path("sky.exr"), self.path("show/v1/sky.exr"))
        self.sky(7, 7, 7, name="show/v2/sky.exr")
        os.symlink("v1", self.path("show/current"))
        os.remove(self.path("sky.exr"))
        os.symlink("show/current/sky.exr", self.path("sky.exr"))
        self.start("hero.lightmap", "-o", "out/lit.exr")
        os.symlink("v2", self.path("show/new"))
        os.replace(self.path("show/new"), self.path("show/current"))
        self.made_anew("sky.exr")
        os.rename(self.path("show"), self.path("away"))
        self.assertIn("no such file", self.next_line("stderr"))
        os.rename(self.path("away/v1"), self.path("away/current.new"))
        os.remove(self.path("away/current"))
        os.rename(self.path("away/current.new"), self.path("away/current"))
        os.rename(self.path("away"), self.path("show"))
        self.made_anew("sky.exr")

    def test_an_interrupt_ends_it_as_it_ends_others(self):
        for number in signal.SIGINT, signal.SIGTERM, signal.SIGHUP:
            self.start("vm.exr", "sky.exr", "-o", "out/lit.exr")
            self.process.send_signal(number)
            self.assertEqual(self.ended(), 1)
            self.assertEqual(self.next_line("stderr"), "makelightmap ERROR: interrupted\n")
            self.assertEqual(os.listdir(self.path("out")), ["lit.exr"])

    def test_what_makes_no_sense_is_refused(self):
        for text, words in (
                ("--watch makes one image again and again: not with --frames", ["-o", "x.####.exr", "--frames", "1-2"]),
                ("not with --dry-run", ["-o", "x.exr", "--dry-run"]),
                ("not with --explain", ["-o", "x.exr", "--explain"]),
                ("--watch cannot be saved in a recipe", ["-o", "x.lightmap"]),
                ("--watch cannot be saved in a recipe", ["--print-recipe"])):
            self.refused(2, text, "makelightmap", "vm.exr", "sky.exr", "--watch", *words)
        shutil.copy(self.path("vm.exr"), self.path("vm.1001.exr"))
        self.refused(2, "not with <UDIM> in -o; give --udim", "makelightmap", "vm.<UDIM>.exr", "sky.exr", "--watch", "-o",
                     "x.<UDIM>.exr")
        os.symlink("sky.exr", self.path("link.exr"))
        for output in "sky.exr", "./vm.exr", "link.exr":
            self.refused(1, "the image is made of this file: --watch would never come to an end", "makelightmap", "vm.exr",
                         "sky.exr", "--watch", "-o", output)
        self.refused(1, '"gone.exr": no such file', "makelightmap", "vm.exr", "gone.exr", "--watch", "-o", "x.exr")

    def test_quiet_says_nothing(self):
        self.start("hero.lightmap", "-o", "out/lit.exr", "--quiet")
        while not os.path.exists(self.path("out/lit.exr")):
            self.assertIsNone(self.process.poll())
        before = os.stat(self.path("out/lit.exr")).st_ino
        self.recipe("exposure = 1")
        while os.stat(self.path("out/lit.exr")).st_ino == before:
            self.assertIsNone(self.process.poll())
        self.process.send_signal(signal.SIGINT)
        self.assertEqual(self.process.wait(timeout=LONGEST), 1)
        self.assertEqual(self.next_line(), "")


if __name__ == "__main__":
    unittest.main()
