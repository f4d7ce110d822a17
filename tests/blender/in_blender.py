# SPDX-License-Identifier: Apache-2.0
"""Installs the add-on from its zip and runs the cases of a file beside this one, or of one class: relight_cases.Relight.
Run by addon_test.py, in Blender."""
import os
import sys
import unittest

import bpy

sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))

bpy.ops.preferences.addon_install(filepath=os.environ["VMLIGHT_ADDON"])
if bpy.ops.preferences.addon_enable(module="vmlight_addon") != {"FINISHED"}:
    sys.exit("the add-on cannot be enabled")
bpy.context.preferences.addons["vmlight_addon"].preferences.folder = os.environ["VMLIGHT_BIN"]

suite = unittest.defaultTestLoader.loadTestsFromName(sys.argv[sys.argv.index("--") + 1])
result = unittest.TextTestRunner(stream=sys.stdout, verbosity=2).run(suite)
if not result.wasSuccessful() or result.testsRun == 0:
    sys.exit(1)
bpy.ops.preferences.addon_disable(module="vmlight_addon")
if hasattr(bpy.types.Scene, "vmlight"):
    sys.exit("the add-on leaves something behind")
print("all cases passed")
