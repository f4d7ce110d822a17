#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""vmview's window for real: under Xvfb, by mouse and keyboard. Skipped (77) where a program for it is missing."""
import os
import shutil
import signal
import subprocess
import sys
import tempfile
import time
import unittest

BIN = os.environ["VMLIGHT_BIN"]
DATA = os.path.join(os.environ["VMLIGHT_SOURCE"], "tests", "data")
LIMIT = 120  # seconds for anything that is waited for; far above what it takes

missing = [program for program in ("Xvfb", "xdotool") if not shutil.which(program)]
try:
    import numpy
    import OpenImageIO
except ImportError:
    missing.append("numpy and OpenImageIO for Python")
if missing:
    print("skipped: missing", ", ".join(missing))
    sys.exit(77)

from drop_files import drop_files  # noqa: E402


def wait_for(what, ready):
    end = time.monotonic() + LIMIT
    while time.monotonic() < end:
        value = ready()
        if value:
            return value
        time.sleep(0.05)
    raise AssertionError("waited in vain for " + what)


class View:
    """A vmview in a folder of its own."""

    def __init__(self, display, *arguments):
        self.folder = tempfile.mkdtemp()
        self.config = tempfile.mkdtemp()
        self.environment = dict(os.environ, DISPLAY=display, XDG_CONFIG_HOME=self.config, LIBGL_ALWAYS_SOFTWARE="1",
                                XDG_RUNTIME_DIR=self.config)  # without one, GLFW 3.4 complains on its way to X11
        self.environment.pop("OCIO", None)
        self.display = display
        self.process = subprocess.Popen([BIN + "/vmview", *arguments, "--size", "640x480", "--gl-debug"],
                                        cwd=self.folder, env=self.environment, stderr=subprocess.PIPE, text=True)
        self.window = wait_for("the window", lambda: self.process.poll() is not None or self.xdotool(
            "search", "--pid", str(self.process.pid), "--name", "vmview"))
        if self.window is True:
            raise AssertionError("vmview ended: " + self.process.stderr.read())
        self.window = self.window.split()[0]
        self.count = 0
        self.wait_until_ready()

    def xdotool(self, *arguments):
        """Nothing of it is an error: windows come and go."""
        done = subprocess.run(["xdotool", *arguments], env=self.environment, capture_output=True, text=True)
        return done.stdout

    def path(self, number):
        return "%s/vmview_%04d.png" % (self.folder, number)

    def wait_until_ready(self):
        """It has the keyboard, and draws. A window that is not there yet takes neither the keyboard nor a key."""
        end = time.monotonic() + LIMIT
        pressed = 0
        while not os.path.exists(self.path(1)):
            if time.monotonic() > end:
                raise AssertionError("waited in vain for a screenshot")
            self.xdotool("windowfocus", self.window)
            self.xdotool("key", "F12")
            pressed += 1
            answer = time.monotonic() + 1
            while not os.path.exists(self.path(1)) and time.monotonic() < answer:
                time.sleep(0.05)
        if pressed == 1:
            self.count = 1
            return
        # Keys that it has not come to yet would pass for those that are pressed later.
        quiet = time.monotonic()
        while time.monotonic() < quiet + 3:
            if os.path.exists(self.path(self.count + 1)):
                self.count += 1
                quiet = time.monotonic()
            time.sleep(0.05)

    def screenshot(self):
        self.count += 1
        self.xdotool("windowfocus", self.window)
        self.xdotool("key", "F12")
        wait_for("a screenshot", lambda: os.path.exists(self.path(self.count)))
        return OpenImageIO.ImageBuf(self.path(self.count)).get_pixels(OpenImageIO.FLOAT)

    def at_rest(self, seems_done=lambda picture: picture.max() > 0):
        """The picture, once it does not change any more."""
        last = self.screenshot()
        end = time.monotonic() + LIMIT
        while time.monotonic() < end:
            time.sleep(0.4)
            picture = self.screenshot()
            if seems_done(picture) and (picture == last).all():
                return picture
            last = picture
        raise AssertionError("the picture never rests")

    def drag(self, button, dx, dy, *keys):
        self.xdotool("mousemove", "320", "300")
        for key in keys:
            self.xdotool("keydown", key)
        self.xdotool("mousedown", str(button))
        time.sleep(0.3)
        for step in range(1, 6):
            self.xdotool("mousemove", str(320 + dx * step // 5), str(300 + dy * step // 5))
            time.sleep(0.1)
        time.sleep(0.3)
        self.xdotool("mouseup", str(button))
        for key in keys:
            self.xdotool("keyup", key)
        self.xdotool("mousemove", "620", "300")

    def click(self, x, y):
        self.xdotool("mousemove", str(x), str(y))
        time.sleep(0.3)
        self.xdotool("mousedown", "1")
        time.sleep(0.3)
        self.xdotool("mouseup", "1")
        time.sleep(0.3)

    def quit(self):
        self.xdotool("windowfocus", self.window)
        self.xdotool("key", "ctrl+q")
        code = self.process.wait(LIMIT)
        return code, self.process.stderr.read()

    def remove(self):
        if self.process.poll() is None:
            self.process.kill()
            self.process.wait()
        self.process.stderr.close()
        shutil.rmtree(self.folder)
        shutil.rmtree(self.config)


def difference(a, b):
    return abs(a - b).max()


class Window(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        read, write = os.pipe()
        cls.server = subprocess.Popen(["Xvfb", "-displayfd", str(write), "-screen", "0", "800x600x24",
                                       "-noreset"],
                                      pass_fds=[write], stderr=subprocess.DEVNULL)
        os.close(write)
        with os.fdopen(read) as answer:
            cls.display = ":" + answer.readline().strip()
        cls.maps = tempfile.mkdtemp()
        cls.map = cls.maps + "/spot_vismap.exr"
        subprocess.run([BIN + "/makevismap", DATA + "/spot.obj", "-o", cls.map, "--resolution", "128", "--samples",
                        "16", "--quiet"], check=True, stderr=subprocess.DEVNULL)

    @classmethod
    def tearDownClass(cls):
        cls.server.terminate()
        cls.server.wait()
        shutil.rmtree(cls.maps)

    def view(self, *arguments):
        view = View(self.display, *arguments)
        self.addCleanup(view.remove)
        return view

    def assert_ends_well(self, view):
        code, errors = view.quit()
        self.assertEqual((code, errors), (0, ""))

    def test_mouse_and_menus(self):
        view = self.view(DATA + "/spot.obj", DATA + "/studio_small_03.hdr", "--vismap", self.map, "--exposure", "-3.5")
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
        view = self.view()
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
            view = self.view(DATA + "/spot.obj", DATA + "/studio_small_03.hdr", "--resolution", "4096", "--samples",
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
