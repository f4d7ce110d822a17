# SPDX-License-Identifier: Apache-2.0
"""Processes of the add-on for Blender, without Blender: their order, progress, messages and end.

Run as: job_test.py, with VMLIGHT_SOURCE (the repository)."""
import os
import threading
import time
import unittest
from unittest import mock

from plain_support import InFolder, executable
from vmlight_addon import job


class Jobs(InFolder):
    def run_script(self, *texts):
        steps = [job.Step(f"part {number}", [executable(self.folder, f"tool{number}", "#!/bin/sh\n" + text)])
                 for number, text in enumerate(texts)]
        return job.run(steps, 60)

    def test_steps_run_in_order_and_what_they_say_is_kept(self):
        done = self.run_script('echo "tool0 WARNING: thin"; echo note >&2', "touch $(dirname $0)/made")
        self.assertEqual((done.error, done.fraction), ("", 1))
        self.assertEqual(sorted(done.log), [("INFO", "note"), ("WARNING", "thin")])
        self.assertTrue(os.path.exists(self.path("made")))

    def test_a_failure_ends_it_with_the_tools_own_words(self):
        done = self.run_script('echo "tool0 ERROR: \\"a.exr\\": full" >&2; exit 1', "touch $(dirname $0)/made")
        self.assertEqual(done.error, '"a.exr": full')
        self.assertFalse(os.path.exists(self.path("made")))
        self.assertEqual(self.run_script("exit 3").error, "tool0 ended with code 3")
        self.assertEqual(self.run_script("kill -9 $$").error, "tool0 ended with signal 9")
        self.assertIn("No such file", job.run([job.Step("", ["/nowhere/tool"])]).error)

    def test_messages_do_not_name_temporary_files(self):
        tool = executable(self.folder, "tool", "#!/bin/sh\necho \"tool ERROR: \\\"$1\\\": too small\"; exit 1\n")
        self.assertEqual(job.run([job.Step("Cube", [tool, "/tmp/a b.glb"])], 60).error, '"Cube": too small')

    def wait_for(self, is_true):
        end = time.monotonic() + 60
        while not is_true():
            self.assertLess(time.monotonic(), end)
            time.sleep(0.01)

    def test_progress_counts_all_steps(self):
        fifo = self.path("fifo")
        os.mkfifo(fifo)
        waits = executable(self.folder, "waits", f'#!/bin/sh\nprintf "\\rbake  50 %%  1 texels/s"; printf "\\r" ; cat {fifo}\n')
        running = job.Job([job.Step("a", [waits]), job.Step("b", [waits])]).start()
        for fraction in 0.25, 0.75:
            self.wait_for(lambda: running.fraction == fraction)
            self.assertIn("bake: 1 texels/s", running.line)
            with open(fifo, "w"):
                pass
        self.assertEqual(running.wait().fraction, 1)

    def test_the_tools_take_it_for_a_terminal(self):
        """Otherwise progress would come in tenths only."""
        self.assertEqual(self.run_script("test -t 2 && test -t 1").error, "")

    def test_without_terminals_it_is_a_pipe(self):
        def no_terminal():
            raise OSError("out of pty devices")
        with mock.patch.object(job.pty, "openpty", no_terminal):
            done = self.run_script('test ! -t 1 && echo "tool0 WARNING: thin"', "exit 3")
        self.assertEqual((done.log, done.error), ([("WARNING", "thin")], "tool1 ended with code 3"))

    def test_cancel_ends_the_process(self):
        for stubborn in "", 'trap "" TERM\n':
            waits = executable(self.folder, "waits", f"#!/bin/sh\n{stubborn}echo started\nwhile true; do sleep 0.05; done\n")
            running = job.Job([job.Step("a", [waits]), job.Step("b", [waits])]).start()
            self.wait_for(lambda: running.log)
            running.cancel()
            self.assertTrue(running.finished)
            self.assertIsNotNone(running._process.poll())
            self.assertEqual((running.cancelled, running.error, len(running.log)), (True, "", 1))

    def test_cancel_before_the_start_starts_nothing(self):
        running = job.Job([job.Step("a", [executable(self.folder, "tool", "#!/bin/sh\ntouch $(dirname $0)/made\n")])])
        running.cancelled = True
        running.start().wait()
        self.assertFalse(os.path.exists(self.path("made")))

    def test_a_job_that_takes_too_long_is_ended(self):
        waits = executable(self.folder, "waits", "#!/bin/sh\nwhile true; do sleep 0.05; done\n")
        self.assertIn("not done within 0.2 s", job.run([job.Step("a", [waits])], 0.2).error)
        self.assertFalse([thread for thread in threading.enumerate() if thread.name == "vmlight"])


if __name__ == "__main__":
    unittest.main(verbosity=1)
