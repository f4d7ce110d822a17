# SPDX-License-Identifier: Apache-2.0
"""Bakes that are cancelled, or fail half way."""
import os
import shlex
import stat
import threading
import time

import bpy
from scene import BIN, Case, plane, preferences, select


class Cancel(Case):
    def cancel_when_running(self):
        from vmlight_addon import status

        def watch():
            end = time.monotonic() + 120  # then it is ended anyway
            while not (status.job and "bake" in status.job.line) and time.monotonic() < end:
                time.sleep(0.005)
            status.job.cancel()

        thread = threading.Thread(target=watch)
        thread.start()
        return thread

    def test_cancel_leaves_nothing(self):
        from vmlight_addon import status
        floor, other = plane(), plane("other")
        select(floor, other)
        self.settings.resolution, self.settings.samples = 2048, 2048  # an hour
        thread = self.cancel_when_running()
        self.assertEqual(bpy.ops.vmlight.bake(), {"CANCELLED"})
        thread.join()
        self.assertEqual(status.log[-1], ("INFO", "Bake cancelled"))
        self.assertIsNone(status.job)
        self.assertFalse(os.path.exists(self.path("vmlight")))
        self.assertEqual((floor.vmlight.vismap, other.vmlight.vismap), ("", ""))

    def test_cancel_keeps_the_maps_before(self):
        floor, other = plane(), plane("other")
        select(floor, other)
        bpy.ops.vmlight.bake()
        with open(self.path("vmlight", "shot_floor_vismap.exr"), "rb") as file:
            before = file.read()
        self.settings.resolution, self.settings.samples = 2048, 2048  # an hour
        self.cancel_when_running()
        bpy.ops.vmlight.bake()
        with open(self.path("vmlight", "shot_floor_vismap.exr"), "rb") as file:
            self.assertEqual(file.read(), before)
        self.assertEqual(self.maps(), ["shot_floor_vismap.exr", "shot_other_vismap.exr"])

    def test_a_failure_half_way_leaves_nothing(self):
        bad = self.path("bin")
        os.mkdir(bad)
        script = os.path.join(bad, "makevismap")
        with open(script, "w") as file:
            file.write(f'#!/bin/sh\ncase "$3" in other) echo "makevismap ERROR: the disk is full" >&2; exit 1;; esac\n'
                       f'exec {shlex.quote(os.path.join(BIN, "makevismap"))} "$@"\n')
        os.chmod(script, os.stat(script).st_mode | stat.S_IXUSR)
        preferences().folder = bad
        floor, other = plane(), plane("other")
        select(floor, other)
        self.assert_refused("the disk is full", bpy.ops.vmlight.bake)
        self.assertFalse(os.path.exists(self.path("vmlight")))
