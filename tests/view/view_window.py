# SPDX-License-Identifier: Apache-2.0
"""vmview's window under Xvfb, for tests by mouse and keyboard. Ends the process with 77, which skips the test, where a program
for it is missing."""
import importlib.util
import os
import shutil
import subprocess
import sys
import tempfile
import time
import unittest

BIN = os.environ["VMLIGHT_BIN"]
DATA = os.path.join(os.environ["VMLIGHT_SOURCE"], "tests", "data")
LIMIT = 120  # seconds for anything that is waited for; far above what it takes

missing = [program for program in ("Xvfb", "xdotool") if not shutil.which(program)]
missing += ["Python's " + module for module in ("numpy", "OpenImageIO") if not importlib.util.find_spec(module)]
if missing:
    print("skipped: missing", ", ".join(missing))
    sys.exit(77)

import OpenImageIO  # noqa: E402


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
        self.process = subprocess.Popen([BIN + "/vmview", *arguments, "--size", "640x480", "--spp", "4", "--gl-debug"],
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
        self.xdotool("mousemove", str(x), str(y), "sleep", "0.15", "mousedown", "1", "sleep", "0.15", "mouseup", "1", "sleep",
                     "0.15")

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


class WindowTest(unittest.TestCase):
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

    def view_of(self, *arguments):
        view = View(self.display, *arguments)
        self.addCleanup(view.remove)
        return view

    def assert_ends_well(self, view):
        code, errors = view.quit()
        self.assertEqual((code, errors), (0, ""))
