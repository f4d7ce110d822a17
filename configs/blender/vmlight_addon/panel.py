# SPDX-License-Identifier: Apache-2.0
"""The panel "Visibility map" of the Render tab."""
import bpy

from . import messages, status, world

ICONS = {"ERROR": "ERROR", "WARNING": "ERROR", "INFO": "INFO"}
SHOWN = 6  # messages
PIXELS_A_LETTER = 7.5


class VMLIGHT_PT_visibility_map(bpy.types.Panel):
    bl_label = "Visibility map"
    bl_idname = "VMLIGHT_PT_visibility_map"
    bl_space_type = "PROPERTIES"
    bl_region_type = "WINDOW"
    bl_context = "render"
    bl_options = {"DEFAULT_CLOSED"}

    def draw(self, context):
        layout, settings = self.layout, context.scene.vmlight
        layout.use_property_split = True
        layout.use_property_decorate = False
        self._bake(layout, settings)
        self._light(layout, settings, context.scene.world)
        self._show(layout, settings)
        columns = int((context.region.width / context.preferences.system.ui_scale - 60) / PIXELS_A_LETTER)
        self._messages(layout, columns)

    @staticmethod
    def _bake(layout, settings):
        column = layout.column()
        column.row().prop(settings, "uv_source", expand=True)
        column.prop(settings, "resolution")
        column.prop(settings, "samples")
        column.prop(settings, "margin")
        column.prop(settings, "basis")
        column.prop(settings, "max_distance")
        column.row().prop(settings, "occluders", expand=True)
        column.prop(settings, "folder")
        if status.job:
            progress(layout, status.job.fraction, status.job.line)
            layout.operator("vmlight.cancel", icon="CANCEL")
        else:
            row = layout.row(align=True)
            row.operator("vmlight.unwrap", icon="UV")
            row.operator("vmlight.bake", icon="RENDER_STILL")

    @staticmethod
    def _light(layout, settings, shown):
        layout.separator()
        column = layout.column()
        column.prop(settings, "follow_world")
        if settings.follow_world:
            background, texture, mapping = world.texture_of(shown)
            if texture:
                column.template_ID(texture, "image", open="image.open")
            if mapping:
                column.prop(mapping.inputs["Rotation"], "default_value", text="Rotation")
            elif texture:
                column.operator("vmlight.add_mapping", icon="ORIENTATION_GIMBAL")
            if background:
                column.prop(background.inputs["Strength"], "default_value", text="Strength")
        else:
            column.prop(settings, "environment")
            column.prop(settings, "rotation", slider=True)
        row = column.row(align=True)
        row.prop(settings, "exposure", slider=True)
        row.operator("vmlight.match_exposure", text="", icon="LIGHT_SUN")
        column.prop(settings, "model")

    @staticmethod
    def _show(layout, settings):
        layout.prop(settings, "use_base_color")
        row = layout.row(align=True)
        row.operator("vmlight.apply", icon="SHADING_TEXTURE")
        row.operator("vmlight.restore", icon="LOOP_BACK")
        row = layout.row(align=True)
        row.operator("vmlight.relight", icon="FILE_REFRESH")
        row.operator("vmlight.copy_command", icon="COPYDOWN")
        layout.separator()
        layout.prop(settings, "turntable")
        layout.operator("vmlight.turntable", icon="RENDER_ANIMATION")

    @staticmethod
    def _messages(layout, columns):
        said = status.log[-SHOWN:] + [("ERROR", fault) for fault in status.light_faults]
        if not said:
            return
        box = layout.box().column(align=True)
        for kind, text in said:
            for number, line in enumerate(messages.wrapped(text, columns)):
                row = box.row()
                row.alert = kind == "ERROR"
                row.label(text=line, icon=ICONS.get(kind, "NONE") if number == 0 else "BLANK1")


def progress(layout, fraction, text):
    """A bar since Blender 4.0, a line before."""
    if hasattr(layout, "progress"):
        layout.progress(factor=fraction, text=text)
    else:
        layout.label(text=f"{100 * fraction:.0f} %  {text}", icon="SORTTIME")


def register():
    bpy.utils.register_class(VMLIGHT_PT_visibility_map)


def unregister():
    bpy.utils.unregister_class(VMLIGHT_PT_visibility_map)
