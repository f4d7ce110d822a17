#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""vmview's window for real, by mouse and keyboard. Skipped (77) where a program for it is missing."""
import os
import signal
import time
import unittest

from view_window import DATA, LIMIT, WindowTest, difference

import numpy  # after view_window, which skips the test where it is missing
from drop_files import drop_files


class Window(WindowTest):
    def test_mouse_and_menus(self):
        view = self.view_of(DATA + "/spot.obj", DATA + "/studio_small_03.hdr", "--vismap", self.map, "--exposure", "-3.5")
        first = view.at_rest()
        covered = first.max(axis=2) > 0.02
        # The object turns, and turns back to the same pixels.
        view.drag(1, 100, 0)
        turned = view.at_rest()
        self.assertGreater(difference(turned, first), 0.2)
        view.drag(1, -100, 0)
        self.assertLess(difference(view.at_rest(), first), 0.02)
        # The light turns alone: the outline stays.
        view.drag(1, 120, 0, "shift")
        lit = view.at_rest()
        self.assertGreater(difference(lit, first), 0.1)
        self.assertLess(((lit.max(axis=2) > 0.02) != covered).mean(), 0.01)
        view.drag(1, -120, 0, "shift")
        self.assertLess(difference(view.at_rest(), first), 0.02)
        # The middle button moves it, the wheel comes nearer, Home goes back.
        view.drag(2, 60, 0)
        moved = view.at_rest().max(axis=2) > 0.02
        self.assertAlmostEqual(float(numpy.argwhere(moved)[:, 1].mean() - numpy.argwhere(covered)[:, 1].mean()), 60,
                               delta=8)
        view.xdotool("key", "Home")
        self.assertLess(difference(view.at_rest(), first), 0.02)
        view.xdotool("mousemove", "320", "300", "click", "4")
        near = view.at_rest()
        self.assertAlmostEqual((near.max(axis=2) > 0.02).sum() / covered.sum(), 1.15 ** 2, delta=0.05)
        view.xdotool("mousemove", "620", "300", "key", "Home")
        self.assertLess(difference(view.at_rest(), first), 0.02)
        # B shows the environment, which is brighter than nothing in the corner.
        view.xdotool("key", "b")
        self.assertGreater(view.at_rest()[-30:, :30].mean(), first[-30:, :30].mean())
        view.xdotool("key", "b")
        self.assertLess(difference(view.at_rest(), first), 0.02)
        # Show, Visibility V: grey.
        view.click(70, 10)
        view.click(110, 55)
        grey = view.at_rest(lambda picture: difference(picture, first) > 0.1)
        self.assertLess(abs(grey[..., 0] - grey[..., 2]).max(), 0.005)
        self.assertGreater(grey.max(), 0.95)
        # Show, UV checker: coloured.
        view.click(70, 10)
        view.click(110, 140)
        checker = view.at_rest(lambda picture: difference(picture, grey) > 0.1)
        self.assertGreater(abs(checker[..., 0] - checker[..., 2]).max(), 0.1)
        self.assert_ends_well(view)
        with open(view.config + "/vmlight/vmview.conf") as file:
            settings = file.read()
        self.assertIn("window = 640x480\n", settings)
        self.assertIn("recent_mesh = " + os.path.realpath(DATA) + "/spot.obj\n", settings)

    def test_drop(self):
        view = self.view_of()
        self.assertEqual(view.screenshot().max(), 0)
        for name in ("studio_small_03.hdr", "spot.obj"):
            self.assertTrue(drop_files(self.display, int(view.window), [DATA + "/" + name]))
        self.assertTrue(drop_files(self.display, int(view.window), [self.map]))
        first = view.at_rest()
        self.assertGreater((first.max(axis=2) > 0.02).mean(), 0.03)
        # What is no picture is refused, and the view stays.
        self.assertTrue(drop_files(self.display, int(view.window), [DATA + "/README.md"]))
        self.assertLess(difference(view.at_rest(), first), 0.02)
        self.assertTrue(drop_files(self.display, int(view.window), [DATA + "/kloppenheim_05.hdr"]))
        other = view.at_rest(lambda picture: difference(picture, first) > 0.1)
        self.assertGreater(difference(other, first), 0.1)
        self.assert_ends_well(view)

    def test_closed_while_baking(self):
        """Nothing is lost, nothing is left, and nobody waits for the bake."""
        for stop in ("quit", signal.SIGTERM):
            view = self.view_of(DATA + "/spot.obj", DATA + "/studio_small_03.hdr", "--resolution", "4096", "--samples",
                             "65536", "--basis", "cells")
            time.sleep(1)
            self.assertIsNone(view.process.poll())
            begin = time.monotonic()
            if stop == "quit":
                self.assert_ends_well(view)
                self.assertTrue(os.path.exists(view.config + "/vmlight/vmview.conf"))
            else:
                view.process.send_signal(stop)
                self.assertEqual(view.process.wait(LIMIT), 1)
            self.assertLess(time.monotonic() - begin, LIMIT / 2)
            # What was asked for, and nothing else.
            self.assertEqual(sorted(os.listdir(view.folder)),
                             [os.path.basename(view.path(i + 1)) for i in range(view.count)])
            leftover = [name for _, _, names in os.walk(view.config) for name in names if name != "vmview.conf"]
            self.assertEqual(leftover, [])


if __name__ == "__main__":
    unittest.main(verbosity=2)
