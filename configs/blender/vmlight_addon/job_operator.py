# SPDX-License-Identifier: Apache-2.0
"""What Unwrap, Bake and Turntable share: vmlight's executables run beside Blender. From the panel (invoke) Blender stays live;
from a script (execute) they return when done."""
import os
import shutil
import tempfile

import bpy

from . import job, mesh_export, status, tools, world

INTERVAL = 0.1  # seconds between looks at the job


class Refused(Exception):
    """What a user has to change first."""


class JobOperator:
    """Writes files, runs steps, then brings the result into Blender; whichever way it ends, its folder is removed."""
    bl_options = {"REGISTER", "UNDO"}

    @classmethod
    def poll(cls, context):
        if status.job:
            cls.poll_message_set("Something is being made: wait or press Cancel")
            return False
        if context.mode != "OBJECT":
            cls.poll_message_set("Leave the current mode: press Tab for object mode")
            return False
        return True

    def prepare(self, context):
        """@returns the steps. @raises Refused, mesh_export.Unusable, tools.Missing, world.Unfollowable"""
        raise NotImplementedError

    def finish(self, context):
        """Takes what the steps made. @returns what to say. @raises Refused, mesh_export.Unusable, OSError"""
        raise NotImplementedError

    def _begin(self, context):
        self._folder, self._made_folder, self._timer, self._job = "", "", None, None
        try:
            steps = self.prepare(context)
        except (Refused, mesh_export.Unusable, tools.Missing, world.Unfollowable, OSError) as fault:
            self._say({"ERROR"}, str(fault))
            self._clean(context)
            return None
        status.log.clear()
        self._job = status.job = job.Job(steps).start()
        return self._job

    def make_folder(self, parent):
        """In the folder where the result goes, so that it can be moved there at once."""
        missing = parent
        while not os.path.isdir(missing):
            self._made_folder, missing = missing, os.path.dirname(missing)
        os.makedirs(parent, exist_ok=True)
        self._parent = parent
        self._folder = tempfile.mkdtemp(prefix=".vmlight-", dir=parent)
        return self._folder

    def invoke(self, context, _event):
        if not self._begin(context):
            return {"CANCELLED"}
        self._timer = context.window_manager.event_timer_add(INTERVAL, window=context.window)
        context.window_manager.modal_handler_add(self)
        return {"RUNNING_MODAL"}

    def modal(self, context, event):
        if event.type == "TIMER":
            status.redraw()
            if self._job.finished:
                return self._end(context)
        return {"PASS_THROUGH"}

    def execute(self, context):
        running = self._begin(context)
        if not running:
            return {"CANCELLED"}
        running.wait()
        return self._end(context)

    def cancel(self, context):
        """Blender ends it: another file is opened, or it quits."""
        if self._job:
            self._job.cancel()
        self._clean(context)

    def _end(self, context):
        done = self._job
        try:
            for kind, text in done.log:
                status.say(kind, text)
                if kind == "WARNING":
                    self.report({"WARNING"}, text)
            if done.cancelled:
                self._say({"INFO"}, f"{self.bl_label} cancelled")
                return {"CANCELLED"}
            if done.error:
                self._say({"ERROR"}, done.error)
                return {"CANCELLED"}
            self._say({"INFO"}, self.finish(context))
            return {"FINISHED"}
        except (Refused, mesh_export.Unusable, OSError) as fault:
            self._say({"ERROR"}, str(fault))
            return {"CANCELLED"}
        finally:
            self._clean(context)

    def _say(self, kind, text):
        self.report(kind, text)
        status.say(next(iter(kind)), text)

    def _clean(self, context):
        status.job = None
        if self._timer:
            context.window_manager.event_timer_remove(self._timer)
            self._timer = None
        if self._folder:
            shutil.rmtree(self._folder, ignore_errors=True)
        if self._made_folder:
            _remove_empty(self._parent, self._made_folder)
        status.redraw()


def _remove_empty(folder, last):
    """The folder and those above it up to `last`, as far as they are empty."""
    try:
        while True:
            os.rmdir(folder)
            if os.path.normpath(folder) == os.path.normpath(last):
                return
            folder = os.path.dirname(folder)
    except OSError:
        return
