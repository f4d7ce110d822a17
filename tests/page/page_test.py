# SPDX-License-Identifier: Apache-2.0
"""The page that vmexport --html writes, in a Chromium without a window: its light against makelightmap's, and real input.

Run as: page_test.py, with VMLIGHT_BIN (the executables' folder) and VMLIGHT_SOURCE. Skipped, with a message, where chromium,
chromedriver or oiiotool is not installed.
"""
import os
import re
import shutil
import subprocess
import tempfile
import unittest

import webdriver

BIN = os.environ["VMLIGHT_BIN"]
DATA = os.path.join(os.environ["VMLIGHT_SOURCE"], "tests/data")
SKIES = ["studio_small_03.hdr", "kloppenheim_05.hdr", "forest_slope.hdr"]
LARGEST_PAGE = 3_000_000
# The map has 16 bits a channel, and the shader rounds as the library does but in divisions and square roots.
LINEAR_ERROR = 1e-3
SHARED = None


def run(program, *words):
    result = subprocess.run([os.path.join(BIN, program), *words, "--quiet"], capture_output=True, text=True)
    assert result.returncode == 0, (program, words, result.stderr)


def pixels_of(path):
    """{(x, y): values} of an image, as oiiotool prints it."""
    result = subprocess.run(["oiiotool", "--dumpdata", path], capture_output=True, text=True, check=True)
    found = re.findall(r"Pixel \((\d+), (\d+)\): ([^\n(]*)", result.stdout)
    return {(int(x), int(y)): [float(v) for v in values.split()] for x, y, values in found}


def setUpModule():
    missing = webdriver.missing_program() or ("" if shutil.which("oiiotool") else "oiiotool")
    if missing:
        raise unittest.SkipTest(missing + " is not installed")
    global FOLDER
    FOLDER = tempfile.mkdtemp(prefix="vmlight-page-")
    unittest.addModuleCleanup(shutil.rmtree, FOLDER)
    os.chdir(FOLDER)
    spot = os.path.join(DATA, "spot.obj")
    skies = [word for sky in SKIES for word in ("--environment", os.path.join(DATA, sky))]
    run("makevismap", spot, "-o", "small.exr", "--resolution", "64", "--samples", "64", "--channels", "normal,coverage")
    run("vmexport", "small.exr", "--mesh", spot, *skies, "--html", "small.html")
    run("makevismap", spot, "-o", "large.exr", "--resolution", "512", "--samples", "4")
    run("vmexport", "large.exr", "--mesh", spot, *skies, "--html", "large.html")


def shared_browser():
    """One for all tests that need no flags: to start it takes longer than most of them."""
    global SHARED
    if SHARED is None:
        SHARED = webdriver.Browser()
        unittest.addModuleCleanup(SHARED.quit)
    SHARED.messages()
    return SHARED


class Page(unittest.TestCase):
    def browse(self, *flags, **options):
        browser = webdriver.Browser(*flags, **options) if flags or options else shared_browser()
        if browser is not SHARED:
            self.addCleanup(browser.quit)
        browser.open("file://" + os.path.join(FOLDER, "small.html"))
        self.assertEqual(browser.run("return document.getElementById('fault').textContent"), "")
        return browser

    def place_of(self, browser, name):
        return browser.run("const r = document.getElementById(arguments[0]).getBoundingClientRect(); return [r.x, r.y, r.width, r.height]",
                           name)

    def test_it_is_one_small_file_that_names_no_other(self):
        for name in "small.html", "large.html":
            with open(name, encoding="utf-8") as file:
                text = file.read()
            self.assertLessEqual(len(text.encode()), LARGEST_PAGE, name)
            addresses = re.findall(r"(?:https?:)?//[\w.-]+\.\w+[^\s\"'<]*", re.sub(r'"[A-Za-z0-9+/=]{64,}"', '""', text))
            self.assertEqual(set(addresses), {"https://www.apache.org/licenses/LICENSE-2.0"})
            self.assertNotRegex(text, r"\b(src|href)=(?!\"data:)|@import|fetch\(|XMLHttpRequest|@\w+@")

    def test_texels_are_lit_as_makelightmap_lights_them(self):
        browser = self.browse()
        subprocess.run(["oiiotool", "small.exr", "--ch", "coverage", "-o", "coverage.exr"], check=True)
        covered = {place for place, values in pixels_of("coverage.exr").items() if values[0] == 1}
        self.assertGreater(len(covered), 1500)
        for number, sky in enumerate(SKIES):
            run("makecfem", os.path.join(DATA, sky), "--stack", "--resolution", "64x32", "-o", "stack.exr")
            for model, degrees in ("ao", 0), ("paper", 90), ("lobe", 0), ("lobe", 205):
                run("makelightmap", "small.exr", "stack.exr", "--model", model, "--env-rotate", f"0,{degrees},0", "-o", "lit.exr")
                texels = browser.run("return Array.from(vmlight.viewer.texels(...arguments))", number, model, degrees)
                truth = pixels_of("lit.exr")
                farthest = max(abs(texels[4 * (64 * y + x) + c] - truth[x, y][c]) for x, y in covered for c in range(3))
                brightest = max(max(truth[place]) for place in covered)
                self.assertGreater(brightest, 0.3)
                print(f"{sky}, {model}, turned by {degrees}: at most {farthest:.2g} of {brightest:.3g}")
                self.assertLess(farthest, LINEAR_ERROR, (sky, model, degrees))
        self.assertEqual(browser.messages(), [])

    def test_the_picture_is_the_light_as_srgb(self):
        """An open square in even light: V is 1, and every model gives that light."""
        with open("square.obj", "w", encoding="utf-8") as file:
            file.write("v -1 -1 0\nv 1 -1 0\nv 1 1 0\nv -1 1 0\nvt 0 0\nvt 1 0\nvt 1 1\nvt 0 1\nvn 0 0 1\n"
                       "f 1/1/1 2/2/1 3/3/1 4/4/1\n")
        light = 0.05, 0.2, 0.45
        subprocess.run(["oiiotool", "--pattern", "constant:color=" + ",".join(map(str, light)), "16x8", "3", "-o", "even.exr"], check=True)
        run("makevismap", "square.obj", "-o", "square.exr", "--resolution", "16", "--samples", "4")
        run("vmexport", "square.exr", "--mesh", "square.obj", "--environment", "even.exr", "--html", "square.html")
        browser = self.browse()
        browser.open("file://" + os.path.join(FOLDER, "square.html"))
        for exposure in 0, 1:
            for model in "ao", "paper", "lobe":
                browser.run("Object.assign(vmlight.state, arguments[0])",
                            {"azimuth": 0.3, "elevation": 0.1, "exposure": exposure, "model": model, "turn": 77})
                width, height, data = browser.picture()
                middle = 4 * (height // 2 * width + width // 2)
                for value, linear in zip(data[middle:middle + 3], light):
                    self.assertLessEqual(abs(value - 255 * (1.055 * (linear * 2 ** exposure) ** (1 / 2.4) - 0.055)), 2, (model, exposure))

    def test_vmcosts_report_has_it_inside(self):
        run("vmcost", os.path.join(DATA, "spot.obj"), os.path.join(DATA, SKIES[0]), "--quick", "--resolution", "32", "--reference-samples",
            "8", "--no-plots", "-o", "report")
        browser = self.browse()
        browser.open("file://" + os.path.join(FOLDER, "report", "report.html"))
        browser.run("document.querySelector('iframe').scrollIntoView()")
        browser.enter_frame(0)
        self.assertEqual(browser.run("return document.getElementById('fault').textContent"), "")
        state, before = browser.run("return vmlight.state"), browser.picture()
        self.assertGreater(len(set(before[2])), 50)
        browser.run("vmlight.state.turn += 90")
        self.assertNotEqual(browser.picture(), before, state)
        self.assertEqual(browser.messages(), [])

    def test_input_changes_what_is_seen(self):
        browser = self.browse()

        def changes(what, names, action):
            state, picture = browser.run("return vmlight.state"), browser.picture()
            action()
            browser.run("return 0")
            now = browser.run("return vmlight.state")
            self.assertEqual({name for name in now if now[name] != state[name]}, set(names), what)
            self.assertTrue(browser.picture() != picture, what)

        x, y, width, height = self.place_of(browser, "view")
        middle = int(x + width / 2), int(y + height / 2)
        changes("drag", ["azimuth", "elevation"], lambda: browser.drag([middle, (middle[0] + 60, middle[1] + 30)]))
        changes("arrow", ["azimuth"], lambda: browser.keys("\ue012"))
        changes("bracket", ["turn"], lambda: browser.keys("]"))
        changes("zoom", ["distance"], lambda: browser.keys("+"))
        x, y, width, height = self.place_of(browser, "turn")
        changes("slider", ["turn"], lambda: browser.drag(
            [(int(x + width * 0.05), int(y + height / 2)), (int(x + width * 0.7), int(y + height / 2))]))
        self.assertGreater(browser.run("return vmlight.state.turn"), 180)
        changes("exposure", ["exposure"], lambda: (browser.run("document.getElementById('exposure').focus()"), browser.keys("\ue014" * 5)))
        changes("wipe", ["wipe"], lambda: (browser.run("document.getElementById('wipe').focus()"), browser.keys("\ue012" * 50)))
        changes("model", ["model"], lambda: (browser.run("document.getElementById('model').focus()"), browser.keys("p")))
        changes("environment", ["environment"], lambda: (browser.run("document.getElementById('environment').focus()"), browser.keys("k")))
        self.assertEqual(browser.messages(), [])

    def test_the_two_sides_of_the_wipe_are_their_models(self):
        browser = self.browse()

        def picture(**values):
            browser.run("Object.assign(vmlight.state, arguments[0])", values)
            width, height, data = browser.picture()
            return [data[4 * width * y:4 * width * (y + 1)] for y in range(height)]

        both = picture(model="lobe", other="ao", wipe=0.5)
        lobe, ao = picture(wipe=1, model="lobe"), picture(wipe=1, model="ao")
        half = len(both[0]) // 8 * 4
        self.assertNotEqual(lobe, ao)
        for row, left, right in zip(both, lobe, ao):
            self.assertTrue(row[:half - 4] == left[:half - 4] and row[half + 4:] == right[half + 4:])

    def test_fingers_on_a_phone(self):
        browser = self.browse(touch=True)
        self.assertEqual(browser.run("return [innerWidth, document.documentElement.scrollWidth]"), [360, 360])
        self.assertGreater(browser.run("return document.getElementById('view').clientHeight"), 200)
        before = browser.run("return vmlight.state")
        browser.drag([(150, 120), (200, 120), (240, 120)], "touch")
        after = browser.run("return vmlight.state")
        self.assertNotEqual(after["azimuth"], before["azimuth"])
        browser.drag([[(100, 100), (70, 100)], [(200, 100), (260, 100)]], "touch")
        self.assertLess(browser.run("return vmlight.state.distance"), after["distance"])
        self.assertEqual(browser.messages(), [])

    def test_nothing_moves_by_itself_where_motion_is_unwanted(self):
        self.assertFalse(self.browse().run("return document.getElementById('spin').disabled"))
        self.assertTrue(self.browse("--force-prefers-reduced-motion").run("return document.getElementById('spin').disabled"))


if __name__ == "__main__":
    unittest.main()
