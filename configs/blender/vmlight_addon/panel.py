# SPDX-License-Identifier: Apache-2.0
"""The panel "Visibility map" of the Render tab."""
import bpy

from . import messages, status, world

ICONS = {"ERROR": "ERROR", "WARNING": "ERROR", "INFO": "INFO"}
SHOWN = 6  # messages
PIXELS_A_LETTER = 7.5


class InRenderTab:
    bl_space_type = "PROPERTIES"
    bl_region_type = "WINDOW"
    bl_context = "render"


class VMLIGHT_PT_visibility_map(InRenderTab, bpy.types.Panel):
    """What is pressed often, and what was said."""
    bl_label = "Visibility map"
    bl_options = {"DEFAULT_CLOSED"}

    def draw(self, context):
        layout = self.layout
        if status.job:
            progress(layout, status.job.fraction, status.job.line)
            layout.operator("vmlight.cancel", icon="CANCEL")
        else:
            row = layout.row(align=True)
            row.operator("vmlight.unwrap", icon="UV")
            row.operator("vmlight.bake", icon="RENDER_STILL")
        row = layout.row(align=True)
        row.operator("vmlight.apply", icon="SHADING_TEXTURE")
        row.operator("vmlight.restore", icon="LOOP_BACK")
        said = status.log[-SHOWN:] + [("ERROR", fault) for fault in status.light_faults]
        if said:
            columns = int((context.region.width / context.preferences.system.ui_scale - 60) / PIXELS_A_LETTER)
            say(layout.box().column(align=True), said, columns)


class VMLIGHT_PT_light(InRenderTab, bpy.types.Panel):
    bl_label = "Light"
    bl_parent_id = "VMLIGHT_PT_visibility_map"

    def draw(self, context):
        layout, settings = split(self.layout), context.scene.vmlight
        layout.prop(settings, "follow_world")
        if settings.follow_world:
            self._world(layout, context.scene.world)
        else:
            layout.prop(settings, "environment")
            layout.prop(settings, "rotation", slider=True)
        row = layout.row(align=True)
        row.prop(settings, "exposure", slider=True)
        row.operator("vmlight.match_exposure", text="", icon="LIGHT_SUN")
        layout.prop(settings, "model")
        layout.prop(settings, "repair")
        layout.prop(settings, "use_base_color")
        row = layout.row(align=True)
        row.operator("vmlight.relight", icon="FILE_REFRESH")
        row.operator("vmlight.copy_command", icon="COPYDOWN")

    @staticmethod
    def _world(layout, shown):
        """The nodes' own values, at hand."""
        background, texture, mapping = world.texture_of(shown)
        if texture:
            layout.template_ID(texture, "image", open="image.open")
        if mapping:
            layout.prop(mapping.inputs["Rotation"], "default_value", index=2, text="Rotation Z")
        elif texture:
            layout.operator("vmlight.add_mapping", icon="ORIENTATION_GIMBAL")
        if background:
            layout.prop(background.inputs["Strength"], "default_value", text="Strength")


class VMLIGHT_PT_bake(InRenderTab, bpy.types.Panel):
    bl_label = "Bake"
    bl_parent_id = "VMLIGHT_PT_visibility_map"
    bl_options = {"DEFAULT_CLOSED"}

    def draw(self, context):
        layout, settings = split(self.layout), context.scene.vmlight
        for name, expand in (("uv_source", True), ("resolution", False), ("samples", False), ("margin", False),
                             ("basis", False), ("max_distance", False), ("occluders", True), ("folder", False)):
            if expand:
                layout.row().prop(settings, name, expand=True)
            else:
                layout.prop(settings, name)


class VMLIGHT_PT_turntable(InRenderTab, bpy.types.Panel):
    bl_label = "Turntable"
    bl_parent_id = "VMLIGHT_PT_visibility_map"
    bl_options = {"DEFAULT_CLOSED"}

    def draw(self, context):
        layout = split(self.layout)
        layout.prop(context.scene.vmlight, "turntable")
        layout.operator("vmlight.turntable", icon="RENDER_ANIMATION")


def split(layout):
    layout.use_property_split = True
    layout.use_property_decorate = False
    return layout.column()


def progress(layout, fraction, text):
    """A bar since Blender 4.0, a line before."""
    if hasattr(layout, "progress"):
        layout.progress(factor=fraction, text=text)
    else:
        layout.label(text=f"{100 * fraction:.0f} %  {text}", icon="SORTTIME")


def say(box, said, columns):
    for kind, text in said:
        for number, line in enumerate(messages.wrapped(text, columns)):
            row = box.row()
            row.alert = kind == "ERROR"
            row.label(text=line, icon=ICONS.get(kind, "NONE") if number == 0 else "BLANK1")


CLASSES = (VMLIGHT_PT_visibility_map, VMLIGHT_PT_light, VMLIGHT_PT_bake, VMLIGHT_PT_turntable)


def register():
    for cls in CLASSES:
        bpy.utils.register_class(cls)


def unregister():
    for cls in reversed(CLASSES):
        bpy.utils.unregister_class(cls)
