#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""The gain maps that vmexport writes, decoded by three.js' GainMapLoader (npm's @monogrid/gainmap-js) in Chromium, against the
lightmap.

Run as: gain_map.py FOLDER_OF_EXECUTABLES
Exit code 77: node's npm, chromium or chromedriver is missing, or the packages cannot be had. They are installed in a temporary
folder."""
import functools
import http.server
import json
import os
import shutil
import subprocess
import sys
import tempfile
import threading

import numpy
import OpenImageIO as oiio

SOURCE = os.path.join(os.path.dirname(os.path.abspath(__file__)), "../..")
sys.path.insert(0, os.path.join(SOURCE, "tests/page"))
import webdriver  # noqa: E402

PACKAGES = "three@0.180.0", "@monogrid/gainmap-js@3.7.3"
SKIPPED = 77
BIN = os.path.abspath(sys.argv[1])
# The browser decodes to half floats: 2^-11 of a value; and GPUs' exp2() and pow() are not exact.
HALF = 2e-3
PAGE = """<!DOCTYPE html><title>gain map</title>
<script type="importmap">{"imports": {"three": "./node_modules/three/build/three.module.js"}}</script>
<script type="module">
import { WebGLRenderer, FloatType, HalfFloatType } from "three";
import { GainMapLoader } from "./node_modules/@monogrid/gainmap-js/dist/decode.js";
const renderer = new WebGLRenderer();
window.decode = files => new Promise((resolve, reject) => new GainMapLoader(renderer).load(files, result => {
  result.render();
  const { width, height } = result;
  const pixels = result.toArray();
  resolve({ width, height, pixels: Array.from(pixels), isHalf: pixels instanceof Uint16Array });
}, undefined, reject));
</script>"""


def run(program, *words):
    subprocess.run([os.path.join(BIN, program), *words, "--quiet"], check=True)


class Quiet(http.server.SimpleHTTPRequestHandler):
    def log_message(self, *_):
        pass


def decoded(browser):
    result = browser.run("return window.decode(arguments[0])", ["vm_lightmap.png", "vm_lightmap_gain.png", "vm_lightmap_gain.json"])
    pixels = numpy.array(result["pixels"])
    if result["isHalf"]:
        pixels = pixels.astype(numpy.uint16).view(numpy.float16)
    # From the bottom row up, as WebGL has it.
    return pixels.astype(float).reshape(result["height"], result["width"], 4)[::-1, :, :3]


def check(browser):
    good = True
    for sky in "studio_small_03", "kloppenheim_05":
        run("makelightmap", "vm.exr", os.path.join(SOURCE, "tests/data", sky + ".hdr"), "-o", "lit.exr")
        run("vmexport", "vm.exr", "--for", "three", "--maps", "ao", "--lightmap", "lit.exr", "--lightmap-encoding", "gain_map", "-o", ".")
        light = oiio.ImageBuf("lit.exr").get_pixels(oiio.FLOAT).astype(float)[..., :3]
        with open("vm_lightmap_gain.json", encoding="utf-8") as file:
            numbers = json.load(file)
        stops = max(most - least for most, least in zip(numbers["gainMapMax"], numbers["gainMapMin"]))
        apart = numpy.abs(decoded(browser) - light) / (light + 1 / 64)
        bound = 2 ** (0.5 * stops / 255) - 1 + HALF
        print(f"{sky}: greatest {light.max():.3g}, gain of {stops:.3g} stops, apart by {apart.max():.2g} at most (bound {bound:.2g})")
        good = good and light.max() > 0.1 and apart.max() <= bound
    return good


def main():
    missing = webdriver.missing_program() or ("" if shutil.which("npm") else "npm")
    if missing:
        print(f"skipped: {missing} is not installed")
        sys.exit(SKIPPED)
    with tempfile.TemporaryDirectory() as folder:
        os.chdir(folder)
        if subprocess.run(["npm", "install", "--no-audit", "--no-fund", "--silent", *PACKAGES]).returncode != 0:
            print("skipped: npm cannot install " + " ".join(PACKAGES))
            sys.exit(SKIPPED)
        with open("index.html", "w", encoding="utf-8") as file:
            file.write(PAGE)
        run("makevismap", os.path.join(SOURCE, "tests/data/spot.obj"), "-o", "vm.exr", "--resolution", "64", "--samples", "64")
        server = http.server.ThreadingHTTPServer(("127.0.0.1", 0), functools.partial(Quiet, directory=folder))
        threading.Thread(target=server.serve_forever, daemon=True).start()
        browser = webdriver.Browser()
        try:
            browser.open(f"http://127.0.0.1:{server.server_port}/index.html")
            good = check(browser)
            messages = browser.messages()
        finally:
            browser.quit()
            server.shutdown()
        print("\n".join(messages), end="")
    sys.exit(0 if good else 1)


main()
