# SPDX-License-Identifier: Apache-2.0
"""What the panel shows of work that goes on, and of what was said."""
import bpy

KEPT = 12

job = None  # the job.Job that runs
log = []  # (kind, text), the newest last: ERROR, WARNING, INFO
light_note = ""  # how the last relight was made
light_faults = []  # why it was not


def say(kind, text):
    if (kind, text) in log:
        log.remove((kind, text))
    log.append((kind, text))
    del log[:-KEPT]


def redraw():
    """The panels that may show it."""
    for window in bpy.context.window_manager.windows if bpy.context.window_manager else ():
        for area in window.screen.areas:
            if area.type == "PROPERTIES":
                area.tag_redraw()
