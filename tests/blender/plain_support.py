# SPDX-License-Identifier: Apache-2.0
"""What tests of the add-on without Blender share. Needs VMLIGHT_SOURCE, the repository."""
import os
import stat
import sys
import tempfile
import unittest

SOURCE = os.environ["VMLIGHT_SOURCE"]
ADDON = os.path.join(SOURCE, "configs/blender/vmlight_addon")
sys.dont_write_bytecode = True
sys.path.insert(0, os.path.dirname(ADDON))


def executable(folder, name, text="#!/bin/sh\n"):
    os.makedirs(folder, exist_ok=True)
    path = os.path.join(folder, name)
    with open(path, "w") as file:
        file.write(text)
    os.chmod(path, os.stat(path).st_mode | stat.S_IXUSR)
    return path


class InFolder(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory(prefix="vmlight-addon-")
        self.addCleanup(folder.cleanup)
        self.folder = folder.name

    def path(self, *names):
        return os.path.join(self.folder, *names)
