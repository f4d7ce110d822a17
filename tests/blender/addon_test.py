# SPDX-License-Identifier: Apache-2.0
"""The add-on in Blender, without a window. Skipped, with a message, where Blender is not installed.

Run as: addon_test.py CASES..., the names of files beside this one or of a class in one, with VMLIGHT_BIN (the executables'
folder), VMLIGHT_SOURCE (the repository), VMLIGHT_ADDON (the zip) and, for a build with sanitizers, VMLIGHT_PRELOAD."""
import os
import shutil
import subprocess
import sys
import tempfile
import unittest

HERE = os.path.dirname(os.path.abspath(__file__))
LIMIT = 600  # seconds


class Addon(unittest.TestCase):
    def run_in_blender(self, case):
        if os.environ.get("VMLIGHT_PRELOAD"):
            self.skipTest("Blender runs under no sanitizer")
        if not shutil.which("blender"):
            self.skipTest("blender is not installed")
        with tempfile.TemporaryDirectory(prefix="vmlight-blender-") as folder:
            # Its own settings: the add-on is installed there. Readers are found by the add-on, not by the environment.
            environment = {name: value for name, value in os.environ.items() if name not in ("OCIO", "OIIO_LIBRARY_PATH")}
            # Debian's Blender takes the modules of the first python3 in $PATH: the one beside it has numpy.
            environment["PATH"] = os.path.dirname(shutil.which("blender")) + os.pathsep + environment["PATH"]
            environment.update(BLENDER_USER_RESOURCES=os.path.join(folder, "blender"), VMLIGHT_FOLDER=folder,
                               PYTHONDONTWRITEBYTECODE="1")
            result = subprocess.run(
                ["blender", "--background", "--factory-startup", "--python-exit-code", "1", "--python",
                 os.path.join(HERE, "in_blender.py"), "--", case],
                stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True, errors="replace", env=environment, timeout=LIMIT)
            self.assertEqual(result.returncode, 0, result.stdout)
            self.assertIn("all cases passed", result.stdout)


def _add(case):
    setattr(Addon, "test_" + case.replace(".", "_"), lambda self: self.run_in_blender(case))


if __name__ == "__main__":
    for named in sys.argv[1:]:
        _add(named)
    unittest.main(argv=sys.argv[:1], verbosity=1)
