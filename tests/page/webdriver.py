# SPDX-License-Identifier: Apache-2.0
"""A Chromium without a window, driven by its chromedriver: W3C WebDriver in as few words as the tests need."""
import base64
import json
import re
import shutil
import subprocess
import urllib.error
import urllib.request

PROGRAMS = "chromium", "chromedriver"
FLAGS = ["--headless=new", "--no-sandbox", "--disable-dev-shm-usage", "--use-angle=swiftshader", "--enable-unsafe-swiftshader",
         "--window-size=600,500", "--disable-background-networking"]


def missing_program():
    """The first that is not installed, or ""."""
    return next((program for program in PROGRAMS if not shutil.which(program)), "")


class Browser:
    def __init__(self, *flags, touch=False):
        self.driver = subprocess.Popen([shutil.which("chromedriver"), "--port=0"], stdout=subprocess.PIPE, stderr=subprocess.DEVNULL,
                                       text=True)
        self.session = ""
        try:
            for line in self.driver.stdout:
                found = re.search(r"started successfully on port (\d+)", line)
                if found:
                    break
            self.address = f"http://127.0.0.1:{found.group(1)}/session"
            options = {"binary": shutil.which("chromium"), "args": [*FLAGS, *flags]}
            if touch:
                options["mobileEmulation"] = {"deviceMetrics": {"width": 360, "height": 640, "pixelRatio": 2, "touch": True}}
            wanted = {"browserName": "chrome", "goog:chromeOptions": options, "goog:loggingPrefs": {"browser": "ALL"}}
            self.session = "/" + self.ask("POST", "", {"capabilities": {"alwaysMatch": wanted}})["sessionId"]
        except BaseException:
            self.quit()
            raise

    def ask(self, method, path, body=None):
        data = None if body is None else json.dumps(body).encode()
        request = urllib.request.Request(self.address + self.session + path, data, {"Content-Type": "application/json"}, method=method)
        try:
            with urllib.request.urlopen(request, timeout=120) as reply:
                return json.load(reply)["value"]
        except urllib.error.HTTPError as error:
            raise AssertionError(error.read().decode(errors="replace")[:2000]) from error

    def open(self, address):
        self.ask("POST", "/url", {"url": address})

    def enter_frame(self, number):
        """Run further scripts in a frame of the page, once it has loaded."""
        self.ask("POST", "/frame", {"id": number})
        self.ask("POST", "/execute/async",
                 {"script": "if (document.readyState === 'complete') arguments[0](); else addEventListener('load', arguments[0]);",
                  "args": []})

    def run(self, script, *arguments):
        return self.ask("POST", "/execute/sync", {"script": script, "args": arguments})

    def messages(self):
        """What the page has said on its console since the last call."""
        return [entry["message"] for entry in self.ask("POST", "/se/log", {"type": "browser"})]

    def drag(self, points, kind="mouse"):
        """Press at the first of the points (x, y) of the window, move through the others, let go. One list of points a finger."""
        fingers = points if isinstance(points[0], list) else [points]
        sources = []
        for number, path in enumerate(fingers):
            move = [{"type": "pointerMove", "x": x, "y": y, "duration": 30} for x, y in path]
            sources.append({"type": "pointer", "id": f"{kind}{number}", "parameters": {"pointerType": kind},
                            "actions": [move[0], {"type": "pointerDown", "button": 0}, *move[1:], {"type": "pointerUp", "button": 0}]})
        self.ask("POST", "/actions", {"actions": sources})

    def keys(self, text):
        actions = [{"type": kind, "value": key} for key in text for kind in ("keyDown", "keyUp")]
        self.ask("POST", "/actions", {"actions": [{"type": "key", "id": "keys", "actions": actions}]})

    def picture(self):
        """The canvas as it is drawn now: width, height, bytes of R, G, B, A from the bottom row up."""
        width, height, text = self.run("""
            const { viewer, state } = vmlight, gl = viewer.gl, canvas = gl.canvas;
            viewer.draw(state, toClip(state, canvas.clientWidth / canvas.clientHeight));
            const bytes = new Uint8Array(4 * canvas.width * canvas.height);
            gl.readPixels(0, 0, canvas.width, canvas.height, gl.RGBA, gl.UNSIGNED_BYTE, bytes);
            let text = "";
            for (let i = 0; i < bytes.length; i += 8192) text += String.fromCharCode(...bytes.subarray(i, i + 8192));
            return [canvas.width, canvas.height, btoa(text)];""")
        return width, height, base64.b64decode(text)

    def quit(self):
        try:
            if self.session:
                self.ask("DELETE", "")
        finally:
            self.driver.terminate()
            self.driver.wait(30)
            self.driver.stdout.close()
