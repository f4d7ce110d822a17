# SPDX-License-Identifier: Apache-2.0
"""Unwrap, Bake, Render Turntable and Cancel."""
import os

import bpy

from . import glb, job, light, mesh_export, preferences, status, tools, unwrap
from .job_operator import JobOperator, Refused


def selected_meshes(context):
    """@raises Refused"""
    objects = [ob for ob in context.selected_objects if ob.type == "MESH"]
    if not objects:
        raise Refused("no mesh is selected: select the objects to bake")
    return objects


def options(settings):
    return {name: getattr(settings, name) for name in ("resolution", "samples", "margin", "basis", "max_distance")}


class VMLIGHT_OT_unwrap(JobOperator, bpy.types.Operator):
    """Make a UV map "vmlight" of the selected meshes, an atlas for the resolution and margin of the map"""
    bl_idname = "vmlight.unwrap"
    bl_label = "Unwrap"

    def prepare(self, context):
        makevismap = preferences.find("makevismap")
        self._jobs, steps, seen = [], [], set()
        folder = self.make_folder(light.session_folder())
        for ob in selected_meshes(context):
            if ob.data in seen:
                continue
            seen.add(ob.data)
            if ob.data.library:
                raise Refused(f'"{ob.name}": its mesh is of a linked file: unwrap it there')
            part = unwrap.part(ob.data, ob.name, ob.matrix_world)
            if part is None:
                raise mesh_export.Unusable(f'"{ob.name}" has no faces, so nothing to unwrap')
            base = os.path.join(folder, str(len(steps)))
            glb.write(base + ".glb", [part])
            self._jobs.append((ob.name, base + "_uv.glb"))
            steps.append(job.Step(ob.name, tools.unwrap_command(makevismap, base + ".glb", base + ".exr", base + "_uv.glb",
                                                                options(context.scene.vmlight))))
        return steps

    def finish(self, context):
        cut = 0
        for name, atlas in self._jobs:
            ob = context.scene.objects.get(name)
            if ob is None:
                continue
            if ob.mode == "EDIT":
                raise Refused(f'"{name}" is being edited: press Tab, then unwrap again')
            count = unwrap.set_uvs(ob.data, atlas)
            cut += count
            copying = [modifier.name for modifier in ob.modifiers
                       if modifier.show_viewport and modifier.type in unwrap.COPYING_MODIFIERS]
            if copying:
                self._say({"WARNING"}, f'"{name}": its modifier {copying[0]} lays copies onto the same UVs: apply it, then '
                                       "unwrap again")
        context.scene.vmlight.uv_source = "UNWRAPPED"
        text = f"{_count(len(self._jobs), 'mesh', 'meshes')} unwrapped"
        return text + (f"; {_count(cut, 'face was', 'faces were')} cut into triangles, where charts meet" if cut else "")


class VMLIGHT_OT_bake(JobOperator, bpy.types.Operator):
    """Bake a visibility map for each selected mesh, with its modifiers. Only needed again when geometry changes"""
    bl_idname = "vmlight.bake"
    bl_label = "Bake"

    def prepare(self, context):
        makevismap, settings = preferences.find("makevismap"), context.scene.vmlight
        objects = selected_meshes(context)
        uv_maps = [self._uv_map(ob, settings) for ob in objects]
        depsgraph = context.evaluated_depsgraph_get()
        parts, nodes = mesh_export.scene_parts(depsgraph, objects, uv_maps, settings.occluders == "VISIBLE")
        target = light.maps_folder(context.scene)
        folder = self.make_folder(target)
        mesh = os.path.join(folder, "scene.glb")
        glb.write(mesh, parts)
        self._maps, steps = [], []
        taken = {os.path.basename(bpy.path.abspath(ob.vmlight.vismap)) for ob in context.scene.objects
                 if ob.vmlight.vismap and ob not in objects}
        for ob, node, uv_map in zip(objects, nodes, uv_maps):
            name = tools.unused_name(_blend_name() + ob.name, "_vismap.exr", taken)
            made = os.path.join(folder, name)
            turn = tuple(ob.evaluated_get(depsgraph).matrix_world.to_quaternion())
            self._maps.append((ob.name, uv_map, turn, made, os.path.join(target, name)))
            steps.append(job.Step(ob.name, tools.bake_command(makevismap, mesh, node, made, options(settings))))
        return steps

    @staticmethod
    def _uv_map(ob, settings):
        if settings.uv_source == "UNWRAPPED":
            if unwrap.LAYER not in ob.data.uv_layers:
                raise Refused(f'"{ob.name}" has no UV map "{unwrap.LAYER}": press Unwrap, or set UVs to Keep')
            return unwrap.LAYER
        name = mesh_export.kept_uv_map(ob.data)
        if not name:
            raise Refused(f'"{ob.name}" has no UV map: press Unwrap')
        return name

    def finish(self, context):
        for name, uv_map, turn, made, path in self._maps:
            os.replace(made, path)
            ob = context.scene.objects.get(name)
            if ob is None:
                continue
            ob.vmlight.vismap = bpy.path.relpath(path) if _can_be_relative(path) else path
            ob.vmlight.uv_map, ob.vmlight.turn = uv_map, turn
        light.refresh(context.scene)
        text = f"{_count(len(self._maps), 'object', 'objects')} baked"
        if light.maps_folder(context.scene) == light.session_folder():
            text += "; the maps are lost when Blender quits: save the .blend, then bake, to keep them"
        return text


class VMLIGHT_OT_turntable(JobOperator, bpy.types.Operator):
    """Render a turntable of the selected meshes with vmframes, over the scene's frame range"""
    bl_idname = "vmlight.turntable"
    bl_label = "Render Turntable"
    bl_options = {"REGISTER"}

    def prepare(self, context):
        vmframes, scene = preferences.find("vmframes"), context.scene
        objects = selected_meshes(context)
        sky = light.environment(scene)
        output = scene.vmlight.turntable
        if output.startswith("//") and not bpy.data.filepath:
            raise Refused(f'Output "{output}" starts at the .blend, which is not saved: save it, or choose a folder')
        self._output = bpy.path.abspath(output)
        os.makedirs(os.path.dirname(self._output), exist_ok=True)
        uv_maps = [ob.vmlight.uv_map or mesh_export.kept_uv_map(ob.data) for ob in objects]
        if not all(uv_maps):
            raise Refused(f'"{objects[uv_maps.index("")].name}" has no UV map: press Unwrap')
        parts, _ = mesh_export.scene_parts(context.evaluated_depsgraph_get(), objects, uv_maps, False)
        folder, colors = self.make_folder(light.session_folder()), mesh_export.base_colors(objects)
        meshes = [os.path.join(folder, f"{number}.glb") for number in range(len(parts))]
        for mesh, part in zip(meshes, parts):
            glb.write(mesh, [part], colors)
        # A map knows where its object was: one that was moved since is baked again.
        ob = objects[0]
        own = light.light_of(ob, scene, sky)
        whole = light.light_of_scene(scene, sky)
        vismap = bpy.path.abspath(ob.vmlight.vismap) if len(objects) == 1 and own == whole else ""
        return [job.Step("turntable", tools.frames_command(
            vmframes, meshes, sky.path, self._output, whole, (scene.frame_start, scene.frame_end), vismap,
            options(scene.vmlight)))]

    def finish(self, context):
        return f'turntable written to "{self._output}"'


class VMLIGHT_OT_cancel(bpy.types.Operator):
    """End what is being made; nothing of it is kept"""
    bl_idname = "vmlight.cancel"
    bl_label = "Cancel"

    @classmethod
    def poll(cls, _context):
        return status.job is not None

    def execute(self, _context):
        status.job.cancel()
        return {"FINISHED"}


def _blend_name():
    """Two .blends in one folder must not overwrite each other's maps."""
    return os.path.splitext(os.path.basename(bpy.data.filepath))[0] + "_" if bpy.data.filepath else ""


def _can_be_relative(path):
    return bool(bpy.data.filepath) and os.path.splitdrive(path)[0] == os.path.splitdrive(bpy.data.filepath)[0]


def _count(number, one, many):
    return f"{number} {one if number == 1 else many}"


CLASSES = (VMLIGHT_OT_unwrap, VMLIGHT_OT_bake, VMLIGHT_OT_turntable, VMLIGHT_OT_cancel)


def register():
    for cls in CLASSES:
        bpy.utils.register_class(cls)


def unregister():
    if status.job:
        status.job.cancel()
    for cls in reversed(CLASSES):
        bpy.utils.unregister_class(cls)
