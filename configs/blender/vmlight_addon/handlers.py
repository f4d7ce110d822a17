# SPDX-License-Identifier: Apache-2.0
"""Relights when the World, an object's rotation or the frame changes; keeps lit textures in saved files."""
import bpy
from bpy.app.handlers import persistent

from . import light, lit_image


@persistent
def changed(scene, depsgraph):
    """Anything was changed: relight if it can show. A relight changes images only, so it does not come back here."""
    for update in depsgraph.updates:
        if isinstance(update.id, (bpy.types.World, bpy.types.ShaderNodeTree)) or (
                isinstance(update.id, bpy.types.Object) and update.is_updated_transform):
            light.schedule()
            return


@persistent
def frame_changed(scene, depsgraph):
    """At once: the frame may be rendered next."""
    light.refresh(scene, depsgraph)


@persistent
def saving(*_):
    lit_image.pack_changed(bpy.data.scenes)


@persistent
def undone(scene, *_):
    """Undo does not bring back pixels."""
    light.refresh(scene, force=True)


HANDLERS = (("depsgraph_update_post", changed), ("frame_change_post", frame_changed), ("save_pre", saving),
            ("undo_post", undone), ("redo_post", undone))


def register():
    for name, function in HANDLERS:
        getattr(bpy.app.handlers, name).append(function)


def unregister():
    for name, function in HANDLERS:
        getattr(bpy.app.handlers, name).remove(function)
