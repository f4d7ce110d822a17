#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""vmview's menus and sliders, by mouse: what they choose is in the commands that they copy. Skipped (77) as window_test.py is."""
import os
import shlex
import unittest

from view_window import DATA, WindowTest, difference, wait_for

from read_clipboard import read_clipboard

CONFIG = os.path.realpath(DATA + "/../../configs/ocio/config.ocio")
MESH, SKY = os.path.realpath(DATA + "/spot.obj"), os.path.realpath(DATA + "/studio_small_03.hdr")
MENUS = {"File": 20, "Show": 70, "Model": 115, "Display": 175}  # x, of their titles


class Menus(WindowTest):
    def setUp(self):
        self.last = None
        self.view = self.view_of(MESH, SKY, "--vismap", self.map, "--exposure", "-3.5", "--model", "paper",
                                 "--colorconfig", CONFIG)
        self.first = self.view.at_rest()

    def choose(self, menu, y, *more):
        """Click an entry of a menu at this y, then entries of its submenus."""
        self.view.click(MENUS[menu], 10)
        self.view.click(MENUS[menu] + 10, y)
        for place in more:
            self.view.click(*place)

    def copied(self, program):
        """The environment and the flags of the command that was copied, which is another than the one before."""
        def read():
            text = read_clipboard(self.view.display)
            return text if text != self.last else None
        self.last = wait_for("a new text in the clipboard", read)
        words = shlex.split(self.last)
        self.assertEqual(words[0], program)
        self.assertEqual(words[1], MESH if program == "vmframes" else self.map)
        return words[2], " ".join(words[3:])

    def command(self):
        self.view.xdotool("windowfocus", self.view.window)
        self.view.xdotool("key", "ctrl+c")
        return self.copied("vmframes")

    def test_file(self):
        kept = "--model paper --exposure -3.5 --colorconfig " + CONFIG
        vismap = "--vismap " + self.map
        self.choose("File", 123)
        self.assertEqual(self.copied("vmframes"), (SKY, f"{vismap} {kept} -o spot.png"))
        self.choose("File", 106)
        self.assertEqual(self.copied("makelightmap"), (SKY, kept + " -o spot_lit.exr"))
        # Environments beside it, then the one that was open before.
        self.choose("File", 34, (320, 51))
        other = self.view.at_rest(lambda picture: difference(picture, self.first) > 0.1)
        self.assertEqual(self.command(), (os.path.dirname(SKY) + "/kloppenheim_05.hdr", f"{vismap} {kept} -o spot.png"))
        self.choose("File", 68, (320, 85))
        self.view.at_rest(lambda picture: difference(picture, other) > 0.1)
        self.assertLess(difference(self.view.at_rest(), self.first), 0.02)
        self.assertEqual(self.command()[0], SKY)
        # The mesh again, without the map, which it bakes.
        self.choose("File", 51, (320, 51))
        self.view.at_rest()
        self.assertEqual(self.command(), (SKY, kept + " -o spot.png"))
        count = self.view.count
        self.choose("File", 89)
        wait_for("a screenshot", lambda: os.path.exists(self.view.path(count + 1)))
        self.choose("File", 144)
        self.assertEqual(self.view.process.wait(60), 0)

    def test_model(self):
        def flags():
            line = self.command()[1]
            return line.replace("--vismap " + self.map, "").replace("--exposure -3.5 --colorconfig " + CONFIG, "").split()
        self.choose("Model", 85)
        lobe = self.view.at_rest(lambda picture: difference(picture, self.first) > 0.01)
        self.assertEqual(flags(), ["--model", "lobe", "-o", "spot.png"])
        self.choose("Model", 157, (230, 191))
        self.assertEqual(flags(), ["--wipe", "lobe,paper", "-o", "spot.png"])
        wiped = self.view.at_rest(lambda picture: difference(picture, lobe) > 0.01)
        self.assertEqual(difference(wiped[:, :320], lobe[:, :320]), 0)
        self.assertLess(difference(wiped[:, 320:], self.first[:, 320:]), 0.02)
        # The line between them is dragged.
        self.view.drag(1, -200, 0)
        moved = self.view.at_rest(lambda picture: difference(picture, wiped) > 0.01)
        self.assertLess(difference(moved[:, 140:], self.first[:, 140:]), 0.02)
        self.choose("Model", 157, (230, 157))
        self.assertEqual(flags(), ["--model", "lobe", "-o", "spot.png"])
        # A map without what a model needs: black, and the command has the model, whose reason vmframes gives.
        self.choose("Model", 136)
        self.assertEqual(flags(), ["--model", "cells", "-o", "spot.png"])
        self.assertEqual(self.view.screenshot().max(), 0)
        self.choose("Model", 34)
        self.choose("Model", 178)
        self.assertEqual(flags(), ["--model", "lobe", "--suns", "auto", "-o", "spot.png"])
        self.choose("Model", 195)
        self.assertEqual(flags(), ["--model", "lobe", "--suns", "auto", "--bounce", "auto", "-o", "spot.png"])
        self.choose("File", 106)
        self.assertIn(" --suns auto --mesh " + MESH + " -o", self.copied("makelightmap")[1])
        self.choose("Model", 178)
        self.choose("Model", 195)
        self.assertEqual(flags(), ["--model", "lobe", "-o", "spot.png"])
        self.assert_ends_well(self.view)

    def test_show_and_display(self):
        kept = f"--vismap {self.map} --model paper --exposure -3.5 --colorconfig {CONFIG} "
        self.choose("Display", 51, (420, 102))
        raw = self.view.at_rest(lambda picture: difference(picture, self.first) > 0.05)
        display = "--display Rec.1886 Rec.709 - Display --view "
        self.assertEqual(self.command()[1], kept + display + "Raw -o spot.png")
        # What is shown raw is linear: the tone-mapped picture is brighter.
        self.assertLess(raw.mean(), self.first.mean())
        self.choose("Display", 51, (420, 51))
        self.assertEqual(self.command()[1], kept + display + "ACES 1.0 - SDR Video -o spot.png")
        tail = display + "ACES 1.0 - SDR Video -o spot.png"
        self.choose("Show", 161)
        self.assertEqual(self.command()[1], kept + "--background environment " + tail)
        self.choose("Show", 178)
        self.assertEqual(self.command()[1], kept + "--background environment --white " + tail)
        self.view.xdotool("key", "w")
        self.choose("Show", 161)
        self.view.drag(3, 80, 30)
        self.assertIn("--azimuth", self.command()[1])
        self.choose("Show", 195)
        self.assertEqual(self.command()[1], kept + tail)
        self.assert_ends_well(self.view)

    def test_sliders(self):
        def number(flag, place):
            """Of a flag of the command, after a click on a slider."""
            self.view.click(*place)
            words = self.command()[1].split()
            self.assertIn(flag, words)
            return words[words.index(flag) + 1]
        self.assertLess(float(number("--exposure", (40, 64))), -5)
        self.assertGreater(float(number("--exposure", (150, 64))), 5)
        # Automatic: the mean becomes middle grey.
        automatic = float(number("--exposure", (245, 64)))
        self.assertTrue(-5 < automatic < 0, automatic)
        turned = number("--rotate", (40, 87)).split(",")
        self.assertTrue(turned[0] == turned[2] == "0" and float(turned[1]) < -90, turned)
        sky = number("--env-rotate", (150, 110)).split(",")
        self.assertTrue(sky[0] == sky[2] == "0" and float(sky[1]) > 90, sky)
        self.assertGreater(float(number("--elevation", (150, 133))), 45)
        self.assertLess(float(number("--fov", (25, 156))), 15)
        self.assert_ends_well(self.view)


if __name__ == "__main__":
    unittest.main(verbosity=2)
