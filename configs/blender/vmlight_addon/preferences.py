# SPDX-License-Identifier: Apache-2.0
"""Where the executables are."""
import bpy

from . import tools


class VmlightPreferences(bpy.types.AddonPreferences):
    bl_idname = __package__

    folder: bpy.props.StringProperty(name="Executables", subtype="DIR_PATH",
                                     description="Folder of makevismap and makelightmap; empty: search $PATH, then next "
                                                 "to the add-on")

    def draw(self, _context):
        self.layout.prop(self, "folder")
        for name in tools.EXECUTABLES:
            try:
                self.layout.label(text=find(name), icon="CHECKMARK")
            except tools.Missing as fault:
                self.layout.label(text=str(fault), icon="ERROR")


def find(name):
    """The path of an executable. @raises tools.Missing"""
    addon = bpy.context.preferences.addons.get(__package__)
    folder = addon.preferences.folder if addon and addon.preferences else ""
    return tools.find(name, bpy.path.abspath(folder) if folder else "")


def register():
    bpy.utils.register_class(VmlightPreferences)


def unregister():
    bpy.utils.unregister_class(VmlightPreferences)
