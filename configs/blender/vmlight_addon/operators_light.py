# SPDX-License-Identifier: Apache-2.0
"""Relight, Apply, Restore, Match Exposure, Add Mapping, Copy as Command: what needs no waiting."""
import math
import shlex

import bpy
import numpy

from . import light, lit_material, render_pixels, status, world

MIDDLE_GREY = 0.18
LUMINANCE = (0.2126, 0.7152, 0.0722)


def _baked(context):
    return [ob for ob in context.selected_objects if ob.vmlight.vismap]


class OnBaked:
    @classmethod
    def poll(cls, context):
        if not any(ob.vmlight.vismap for ob in context.selected_objects):
            cls.poll_message_set("No selected object is baked: press Bake")
            return False
        return True

    def faults(self):
        """Reports why light could not be made. @returns whether there was something to report"""
        for fault in status.light_faults:
            self.report({"ERROR"}, fault)
        return bool(status.light_faults)


class VMLIGHT_OT_relight(OnBaked, bpy.types.Operator):
    """Light all baked objects again, also if nothing seems to have changed"""
    bl_idname = "vmlight.relight"
    bl_label = "Relight"
    bl_options = {"REGISTER", "UNDO"}

    def execute(self, context):
        render_pixels.forget()
        light.refresh(context.scene, force=True)
        return {"CANCELLED"} if self.faults() else {"FINISHED"}


class VMLIGHT_OT_apply(OnBaked, bpy.types.Operator):
    """Show the light on the selected objects, in place of their materials, which Restore brings back"""
    bl_idname = "vmlight.apply"
    bl_label = "Apply"
    bl_options = {"REGISTER", "UNDO"}

    def execute(self, context):
        light.refresh(context.scene)
        if self.faults():
            return {"CANCELLED"}
        for ob in _baked(context):
            lit_material.apply(ob, context.scene.vmlight.use_base_color)
        return {"FINISHED"}


class VMLIGHT_OT_restore(bpy.types.Operator):
    """Bring back the materials that the selected objects had before Apply"""
    bl_idname = "vmlight.restore"
    bl_label = "Restore"
    bl_options = {"REGISTER", "UNDO"}

    @classmethod
    def poll(cls, context):
        return any(ob.vmlight.applied for ob in context.selected_objects)

    def execute(self, context):
        for ob in context.selected_objects:
            lit_material.restore(ob)
        return {"FINISHED"}


class VMLIGHT_OT_match_exposure(OnBaked, bpy.types.Operator):
    """Choose the exposure that brings the mean of the selected objects' light to middle grey, 0.18"""
    bl_idname = "vmlight.match_exposure"
    bl_label = "Match Exposure"
    bl_options = {"REGISTER", "UNDO"}

    def execute(self, context):
        light.refresh(context.scene)
        if self.faults():
            return {"CANCELLED"}
        total, count = 0.0, 0
        for image in {ob.vmlight.image for ob in _baked(context)}:
            values = numpy.empty(len(image.pixels), numpy.float32)
            image.pixels.foreach_get(values)
            luminance = values.reshape(-1, 4)[:, :3].astype(float) @ LUMINANCE
            lit = luminance > 0  # the margin too
            total, count = total + luminance[lit].sum(), count + lit.sum()
        if not count:
            self.report({"ERROR"}, "no texel is lit: the environment is black")
            return {"CANCELLED"}
        context.scene.vmlight.exposure += math.log2(MIDDLE_GREY * count / total)
        light.refresh(context.scene)
        return {"FINISHED"}


class VMLIGHT_OT_add_mapping(bpy.types.Operator):
    """Add a Mapping node to the World's Environment Texture, to turn it"""
    bl_idname = "vmlight.add_mapping"
    bl_label = "Add Mapping"
    bl_options = {"REGISTER", "UNDO"}

    @classmethod
    def poll(cls, context):
        _, texture, mapping = world.texture_of(context.scene.world)
        return texture is not None and mapping is None

    def execute(self, context):
        _, texture, _ = world.texture_of(context.scene.world)
        tree, vector = context.scene.world.node_tree, texture.inputs["Vector"]
        mapping = tree.nodes.new("ShaderNodeMapping")
        mapping.location = (texture.location.x - 200, texture.location.y)
        if vector.is_linked:
            source = vector.links[0].from_socket
        else:
            coordinate = tree.nodes.new("ShaderNodeTexCoord")
            coordinate.location = (texture.location.x - 400, texture.location.y)
            source = coordinate.outputs["Generated"]
        tree.links.new(source, mapping.inputs["Vector"])
        tree.links.new(mapping.outputs["Vector"], vector)
        return {"FINISHED"}


class VMLIGHT_OT_copy_command(OnBaked, bpy.types.Operator):
    """Copy the makelightmap command of what the active object shows"""
    bl_idname = "vmlight.copy_command"
    bl_label = "Copy as Command"

    def execute(self, context):
        ob = context.active_object if context.active_object in _baked(context) else _baked(context)[0]
        try:
            context.window_manager.clipboard = shlex.join(light.command(ob, context.scene))
        except world.Unfollowable as fault:
            self.report({"ERROR"}, str(fault))
            return {"CANCELLED"}
        self.report({"INFO"}, "the command is on the clipboard")
        return {"FINISHED"}


CLASSES = (VMLIGHT_OT_relight, VMLIGHT_OT_apply, VMLIGHT_OT_restore, VMLIGHT_OT_match_exposure, VMLIGHT_OT_add_mapping,
           VMLIGHT_OT_copy_command)


def register():
    for cls in CLASSES:
        bpy.utils.register_class(cls)


def unregister():
    for cls in reversed(CLASSES):
        bpy.utils.unregister_class(cls)
