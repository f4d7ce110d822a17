# SPDX-License-Identifier: Apache-2.0
"""What the tests of hard machines share: runs with a limit, and what each may end in.

Run as: machine_test.py, with VMLIGHT_BIN, VMLIGHT_SOURCE, and oiiotool on the path."""
import os
import re
import subprocess
import sys

sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "cli"))

from case import BIN, QUAD, SKY, SPOT, Case  # noqa: E402
from hard_case import skip_row, write_row  # noqa: E402

LIMIT = 300  # seconds for a run that takes one: on a busy machine, under sanitizers, it still has not hung
SMALL = ["--resolution", "16", "--samples", "4", "--quiet"]
__all__ = ["BIN", "LIMIT", "QUAD", "SKY", "SMALL", "SPOT", "HardCase"]


class HardCase(Case):
    def row(self, case, naive, ours, peers=""):
        write_row(self, case, naive, ours, peers)

    def skip(self, reason):
        skip_row(self, reason)

    def run_tool(self, *words, **options):
        """Ends within the limit, or fails. `options` are those of subprocess.run()."""
        words = [os.path.join(BIN, words[0]), *words[1:]]
        settings = dict(capture_output=True, text=True, errors="replace", cwd=self.folder, env=self.environment)
        return subprocess.run(words, timeout=LIMIT, **{**settings, **options})

    def told(self, result, code, text=""):
        """It ended with `code` and one line, which holds `text`."""
        self.assertEqual(result.returncode, code, (result.args, result.stdout, result.stderr))
        # Warnings are of the work before; libpng has its own.
        lines = [line for line in result.stderr.splitlines() if not re.match("libpng |[a-z]+ WARNING: ", line)]
        self.assertEqual(len(lines), 1, result.stderr)
        self.assertRegex(lines[0], "^make[a-z]+ ERROR: ")
        self.assertIn(text, lines[0])

    def reader(self, name):
        """oiiotool, that reads a recipe. It ends by its own will: returns its code and what it said."""
        environment = dict(self.environment, LD_PRELOAD=os.environ.get("VMLIGHT_PRELOAD", ""),
                           OIIO_LIBRARY_PATH=os.path.join(BIN, "../plugins"),
                           ASAN_OPTIONS=os.environ.get("ASAN_OPTIONS", "") + ":detect_leaks=0")
        result = subprocess.run(["oiiotool", name, "-d", "float", "-o", "read.exr"], capture_output=True, text=True,
                                errors="replace", cwd=self.folder, env=environment, timeout=LIMIT)
        self.assertIn(result.returncode, (0, 1), (name, result.stderr))
        return result.returncode, result.stdout + result.stderr

    def assert_finite(self, image):
        stats = self.oiiotool("-a", image, "--printstats")
        counts = re.findall(r"(?:Nan|Inf)Count: (.*)", stats)
        self.assertTrue(counts, stats)
        for line in counts:
            self.assertFalse(set(line.split()) - {"0"}, stats)

    def names(self):
        return sorted(os.listdir(self.folder))
