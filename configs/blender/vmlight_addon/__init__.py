# SPDX-License-Identifier: Apache-2.0
"""Visibility maps in Blender: unwrap, bake, relight and apply, in the Render tab. docs/blender.md says how to use it.

Modules without `bpy` hold what needs no Blender: tools, messages, job, orientation, color_spaces, recipe, glb.
The others import them; this file imports nothing before register(), so that tests reach the first without Blender.
"""

bl_info = {
    "name": "Visibility Maps (vmlight)",
    "author": "vmlight",
    "version": (0, 2, 0),
    "blender": (3, 4, 0),
    "location": "Properties > Render > Visibility map",
    "description": "Bake visibility maps and relight them under any environment, in place",
    "category": "Render",
}


def _modules():
    from . import handlers, operators_bake, operators_light, panel, preferences, settings
    return settings, preferences, operators_bake, operators_light, panel, handlers


def register():
    for module in _modules():
        module.register()


def unregister():
    for module in reversed(_modules()):
        module.unregister()
