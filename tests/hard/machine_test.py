# SPDX-License-Identifier: Apache-2.0
"""Hard machines: killed, full, small, crowded, without what a process usually finds."""
import os
import random
import resource
import shutil
import signal
import subprocess
import sys
import time
import unittest

from hard_files import BIN, LIMIT, QUAD, SKY, SMALL, SPOT, HardCase


class Machine(HardCase):
    BAKE = ["makevismap", SPOT, "--resolution", "384", "--samples", "4", "--quiet"]

    def setUp(self):
        super().setUp()
        self.file("quad.obj", QUAD)

    def start(self, *words, **options):
        return subprocess.Popen([os.path.join(BIN, words[0]), *words[1:]], cwd=self.folder, env=self.environment,
                                stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, text=True, **options)

    def test_killed_at_any_moment(self):
        self.done(*self.BAKE, "-o", "new.exr")
        new, old = self.read("new.exr"), b"the old picture"
        os.remove(self.path("new.exr"))
        begin = time.monotonic()
        self.done(*self.BAKE, "-o", "new.exr")
        whole = time.monotonic() - begin
        os.remove(self.path("new.exr"))
        moments = random.Random(5)
        killed = 0
        names = self.names() + ["x.exr"]
        for i in range(60):
            self.file("x.exr", old)
            process = self.start(*self.BAKE, "-o", "x.exr")
            time.sleep(moments.random() * whole)
            process.send_signal(signal.SIGINT if i % 2 else signal.SIGKILL)
            process.communicate(timeout=LIMIT)
            killed += process.returncode != 0
            self.assertIn(process.returncode, (0, 1, -signal.SIGINT, -signal.SIGKILL))
            self.assertTrue(self.read("x.exr") == (new if process.returncode == 0 else old)
                            or (process.returncode < 0 and self.read("x.exr") == new), "half a file")
            self.assertEqual(self.names(), sorted(names), "debris")
        self.assertGreater(killed, 0)
        self.row("A run is killed (`kill -9`, Ctrl-C) at 60 moments, from its start to its end",
                 "a file written in place is cut; a temporary file beside it stays for ever",
                 "the old file or the new one, and nothing else in the folder")


if __name__ == "__main__":
    unittest.main(argv=[sys.argv[0], *sys.argv[1:]])
