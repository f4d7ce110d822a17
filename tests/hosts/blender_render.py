# SPDX-License-Identifier: Apache-2.0
"""Render a mesh whose every texel glows with a texture, seen along -z by a square orthographic camera of side 2:

    blender --background --factory-startup --python blender_render.py -- MESH.obj TEXTURE RESOLUTION OUTPUT.exr

Prints "rendered" when the render is written.
"""
import sys

import bpy

mesh_path, texture_path, resolution, output = sys.argv[sys.argv.index("--") + 1:]

bpy.ops.wm.read_factory_settings(use_empty=True)
bpy.ops.wm.obj_import(filepath=mesh_path, forward_axis="Y", up_axis="Z")  # the file's own axes
mesh = next(o for o in bpy.context.scene.objects if o.type == "MESH")

material = bpy.data.materials.new("glow")
material.use_nodes = True
nodes = material.node_tree.nodes
nodes.clear()
texture = nodes.new("ShaderNodeTexImage")
texture.image = bpy.data.images.load(texture_path)
texture.image.colorspace_settings.name = "Linear"
texture.interpolation = "Closest"
emission = nodes.new("ShaderNodeEmission")
surface = nodes.new("ShaderNodeOutputMaterial")
material.node_tree.links.new(texture.outputs["Color"], emission.inputs["Color"])
material.node_tree.links.new(emission.outputs[0], surface.inputs["Surface"])
mesh.data.materials.clear()
mesh.data.materials.append(material)

scene = bpy.context.scene
scene.world = bpy.data.worlds.new("black")
scene.render.engine = "CYCLES"
scene.cycles.device = "CPU"
scene.cycles.samples = 1
scene.cycles.use_denoising = scene.cycles.use_adaptive_sampling = False
scene.cycles.pixel_filter_type = "BOX"
scene.cycles.filter_width = 0.01  # rays through the pixel centres
scene.render.resolution_x = scene.render.resolution_y = int(resolution)
scene.render.image_settings.file_format = "OPEN_EXR"
scene.render.image_settings.color_depth = "32"
scene.view_settings.view_transform = "Raw"

camera = bpy.data.objects.new("camera", bpy.data.cameras.new("camera"))
camera.data.type, camera.data.ortho_scale = "ORTHO", 2
camera.location = (0, 0, 5)
scene.collection.objects.link(camera)
scene.camera = camera

scene.render.filepath = output
bpy.ops.render.render(write_still=True)
print("rendered")
