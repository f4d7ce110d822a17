# SPDX-License-Identifier: Apache-2.0
"""Relights when the World, an object's rotation or the frame changes; keeps lit textures in saved files."""
import bpy
from bpy.app.handlers import persistent

from . import light, lit_image


@persistent
def changed(scene, depsgraph):
    """Anything was changed: relight if it can show. A relight changes images only, so it does not come back here."""
    if light.is_rendering:
        return
    for update in depsgraph.updates:
        if isinstance(update.id, (bpy.types.World, bpy.types.ShaderNodeTree)) or (
                isinstance(update.id, bpy.types.Object) and update.is_updated_transform):
            light.schedule(depsgraph)
            return


@persistent
def frame_changed(scene, depsgraph):
    """At once: the frame may be rendered next."""
    light.refresh(scene, depsgraph)


@persistent
def render_started(*_):
    """From here on only frame_changed() knows what a frame shows: the scene itself stays at another."""
    light.is_rendering = True


@persistent
def render_ended(*_):
    light.is_rendering = False
    light.schedule()


@persistent
def saving(*_):
    lit_image.pack_changed(bpy.data.scenes)


@persistent
def undone(scene, *_):
    """Undo does not bring back pixels."""
    light.refresh(scene, force=True)


HANDLERS = (("depsgraph_update_post", changed), ("frame_change_post", frame_changed), ("save_pre", saving),
            ("undo_post", undone), ("redo_post", undone), ("render_init", render_started), ("render_complete", render_ended),
            ("render_cancel", render_ended))


def register():
    for name, function in HANDLERS:
        getattr(bpy.app.handlers, name).append(function)


def unregister():
    for name, function in HANDLERS:
        getattr(bpy.app.handlers, name).remove(function)
