# SPDX-License-Identifier: Apache-2.0
"""The plugins as libraries: what they export, and what they share. (What they read is in the C++ tests beside this file
and in tests/hosts.)

Run as: reader_test.py, with OIIO_LIBRARY_PATH (the plugins' folder)."""
import os
import re
import subprocess
import sys
import unittest

PLUGINS = os.environ["OIIO_LIBRARY_PATH"]


class Symbols(unittest.TestCase):
    @staticmethod
    def shown(library):
        lines = subprocess.run(["nm", "-D", "--defined-only", os.path.join(PLUGINS, library)], check=True,
                               capture_output=True, text=True).stdout.splitlines()
        return sorted(line.split()[-1] for line in lines)

    def test_a_plugin_shows_its_own_symbols_only(self):
        for stage in ("vismap", "cfem", "lightmap"):
            self.assertEqual(self.shown(stage + ".imageio.so"),
                             sorted(stage + name for name in ("_imageio_version", "_imageio_library_version",
                                                              "_input_imageio_create", "_input_extensions")))

    def test_what_they_share_is_in_a_process_once(self):
        shared, = (name for name in os.listdir(PLUGINS) if re.fullmatch(r"libvmlight_readers\.so\.\d+\.\d+", name))
        self.assertEqual(self.shown(shared), ["vmlight_create_reader"])
        for stage in ("vismap", "cfem", "lightmap"):
            needed = subprocess.run(["readelf", "-d", os.path.join(PLUGINS, stage + ".imageio.so")], check=True,
                                    capture_output=True, text=True).stdout
            self.assertIn(shared, needed)


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1] + sys.argv[1:], verbosity=2)
