# SPDX-License-Identifier: Apache-2.0
"""configs/slurm/vmlight-farm.sh on a cluster of two nodes, whose tasks are killed, and one of which crashes.

Run with VMLIGHT_BIN (the executables' folder) and VMLIGHT_SOURCE (the repository)."""
import glob
import os
import pathlib
import random
import shutil
import subprocess
import sys
import tempfile
import time
import unittest

import slurm_cluster
from slurm_cluster import Cluster

BIN = os.environ["VMLIGHT_BIN"]
SOURCE = os.environ["VMLIGHT_SOURCE"]
SCRIPT = os.path.join(SOURCE, "configs/slurm/vmlight-farm.sh")
SPOT = os.path.join(SOURCE, "tests/data/spot.obj")
FLAGS = [SPOT, "--resolution", "256", "--samples", "512"]
PARTS = 8
UP = "idle", "allocated", "mixed"  # states of a node that answers


class Farm(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        reason = slurm_cluster.missing()
        if reason:
            raise unittest.SkipTest("Slurm: " + reason)
        cls.folder = tempfile.mkdtemp(prefix="vmlight_farm_")
        cls.addClassCleanup(shutil.rmtree, cls.folder)
        os.mkdir(os.path.join(cls.folder, "cluster"))
        try:
            cls.cluster = Cluster(os.path.join(cls.folder, "cluster"))
        except (OSError, subprocess.SubprocessError) as error:  # TimeoutError is an OSError
            raise unittest.SkipTest(f"Slurm: its daemons do not start on this machine: {error}")
        cls.addClassCleanup(cls.cluster.stop)
        cls.cluster.environment["PATH"] = BIN + ":" + os.environ["PATH"]
        subprocess.run([os.path.join(BIN, "makevismap"), *FLAGS, "--quiet", "-o", os.path.join(cls.folder, "whole.exr")],
                       check=True)

    def setUp(self):
        self.work = tempfile.mkdtemp(dir=self.folder)

    def submit(self, *flags):
        command = [SCRIPT, str(PARTS), "--chdir", self.work, "--open-mode=append", "--", *flags]
        result = subprocess.run(command, capture_output=True, text=True, env=self.cluster.environment, timeout=60)
        self.assertEqual(result.returncode, 0, result.stderr)
        return result.stdout

    def queue(self):
        return self.cluster.run("squeue", "-h", "-o", "%i %T").split("\n")[:-1]

    def bakes(self):
        """The bakes that run now: their parts, and the numbers of their processes."""
        found = {}
        for number, name in self.cluster.processes().items():
            try:
                words = pathlib.Path(f"/proc/{number}/cmdline").read_text().split("\0")
            except OSError:  # it has ended
                continue
            if name == "makevismap" and "--part" in words:
                found[words[words.index("--part") + 1]] = number
        return found

    def logs(self):
        return "".join(path.read_text() for path in pathlib.Path(self.work).glob("slurm-*.out"))

    def expect_whole(self):
        with open(os.path.join(self.folder, "whole.exr"), "rb") as whole, \
                open(os.path.join(self.work, "vm.exr"), "rb") as joined:
            self.assertEqual(joined.read(), whole.read())
        left = [name for name in os.listdir(self.work) if not name.startswith("slurm-")]
        self.assertEqual(left, ["vm.exr"])

    def test_killed_tasks_and_a_crashed_node_change_no_byte(self):
        chance = random.Random(1)
        self.assertRegex(self.submit(*FLAGS, "-o", "vm.exr"), r"^job \d+ bakes 8 parts, job \d+ joins them to vm.exr$")
        killed = set()
        while len(killed) < PARTS // 2:
            self.assertTrue(self.queue(), "all is done already")
            bakes = self.bakes()
            if parts := sorted(bakes.keys() - killed):
                time.sleep(chance.uniform(0, 0.2))
                part = chance.choice(parts)
                if slurm_cluster.kill(bakes[part]):
                    killed.add(part)
        self.cluster.wait(lambda: self.cluster.processes("n2"))
        self.cluster.crash("n2")
        self.cluster.start("n2")
        self.cluster.wait(lambda: self.cluster.run("sinfo", "-h", "-n", "n2", "-o", "%T").strip() in UP)
        self.cluster.wait(lambda: not self.queue())
        self.assertIn("was killed", self.logs())
        self.expect_whole()

    def test_without_a_part_nothing_is_joined_until_it_is_there(self):
        # A part that cannot be written.
        blocked = os.path.join(self.work, "vm.part3of8.exr")
        os.mkdir(blocked)
        self.submit(*FLAGS, "-o", "vm.exr")
        self.cluster.wait(lambda: not self.queue())
        self.assertFalse(os.path.exists(os.path.join(self.work, "vm.exr")), self.logs())
        self.assertEqual(len(glob.glob(os.path.join(self.work, "vm.part*"))), PARTS)
        os.rmdir(blocked)
        self.submit(*FLAGS, "-o", "vm.exr")
        self.cluster.wait(lambda: not self.queue())
        self.assertEqual(self.logs().count("resume: 1 of 1 part was there already"), PARTS - 1)
        self.expect_whole()


class Joining(unittest.TestCase):
    """The job that joins, with a makevismap that notes its arguments; needs no cluster."""

    def setUp(self):
        self.folder = tempfile.mkdtemp(prefix="vmlight_farm_")
        self.addCleanup(shutil.rmtree, self.folder)
        self.tools = os.path.join(self.folder, "tools")
        self.work = os.path.join(self.folder, "work")
        os.mkdir(self.tools)
        os.mkdir(self.work)
        self.tool("makevismap", 'printf "%s\\n" "$@" >>../joins')

    def tool(self, name, text):
        path = pathlib.Path(self.tools, name)
        path.write_text("#!/bin/bash\n" + text + "\n")
        path.chmod(0o755)

    def parts(self, *names):
        for name in names:
            pathlib.Path(self.work, name).touch()

    def join(self, *flags):
        return subprocess.run([SCRIPT, "join", "2", "hero.obj", *flags], cwd=self.work, timeout=60,
                              env={**os.environ, "PATH": self.tools + ":" + os.environ["PATH"]}).returncode

    def joins(self):
        return pathlib.Path(self.folder, "joins").read_text().split()

    def test_requeued_while_parts_are_removed_it_removes_the_rest(self):
        self.parts("vm.part1of2.exr", "vm.part2of2.exr", "other.part1of2.exr")
        self.tool("rm", 'command -p rm -f vm.part1of2.exr; exit 1')
        self.assertNotEqual(self.join("-o", "vm.exr"), 0)
        os.remove(os.path.join(self.tools, "rm"))
        self.assertIn("vm.part2of2.exr", os.listdir(self.work))
        self.assertEqual(self.join("-o", "vm.exr"), 0)
        self.assertEqual(os.listdir(self.work), ["other.part1of2.exr"])
        self.assertEqual(self.joins(), ["--join", "vm.part1of2.exr", "vm.part2of2.exr", "-o", "vm.exr"])  # once

    def test_every_map_is_joined_and_stored_as_asked(self):
        self.parts("vm_hut.part1of2.exr", "vm_tree.part1of2.exr", "vm_hut.part2of2.exr", "vm_tree.part2of2.exr")
        self.assertEqual(self.join("-o", "vm_<INSTANCE>.exr", "--format", "half", "--samples", "8", "--compression=none"), 0)
        self.assertEqual(os.listdir(self.work), [])
        self.assertEqual(self.joins(), ["--join", "vm_hut.part1of2.exr", "vm_hut.part2of2.exr", "vm_tree.part1of2.exr",
                                        "vm_tree.part2of2.exr", "-o", "vm_<INSTANCE>.exr", "--format", "half",
                                        "--compression=none"])


class Refusals(unittest.TestCase):
    """Need no cluster."""

    def refused(self, text, *words):
        result = subprocess.run([SCRIPT, *words], capture_output=True, text=True)
        self.assertEqual((result.returncode, result.stdout), (2, ""))
        self.assertIn("vmlight-farm.sh ERROR: " + text, result.stderr)

    def test_what_makes_no_sense_is_refused(self):
        self.refused("the number of parts is missing")
        self.refused("the number of parts is missing", "0", "--", "hero.obj", "-o", "x.exr")
        self.refused("-- and the options of makevismap are missing", "4", "--partition=bake")
        self.refused("-o OUTPUT.exr is missing", "4", "--", "hero.obj")
        self.refused("-o OUTPUT.exr is missing", "4", "--", "hero.obj", "-o")
        self.refused("--part is set by this script", "4", "--", "hero.obj", "-o", "x.exr", "--part", "1/2")
        result = subprocess.run([SCRIPT, "--help"], capture_output=True, text=True)
        self.assertEqual((result.returncode, result.stderr), (0, ""))
        self.assertIn("Usage: vmlight-farm.sh PARTS", result.stdout)


if __name__ == "__main__":
    unittest.main(argv=sys.argv)
