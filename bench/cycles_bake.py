# SPDX-License-Identifier: Apache-2.0
"""Bake ambient occlusion with Cycles, for bench/peers.sh:

    blender --background --factory-startup --python cycles_bake.py -- MESH.obj RESOLUTION SAMPLES THREADS OUTPUT.exr

Same question as makevismap's `visibility`: infinite distance, the file's smooth normals, no margin, no denoising, no
adaptive sampling, no clamping.
"""
import sys

import bpy

mesh_path, resolution, samples, threads, output = sys.argv[sys.argv.index("--") + 1:]
resolution, samples, threads = int(resolution), int(samples), int(threads)

bpy.ops.wm.read_factory_settings(use_empty=True)
bpy.ops.wm.obj_import(filepath=mesh_path)
mesh = next(o for o in bpy.context.scene.objects if o.type == "MESH")

scene = bpy.context.scene
scene.render.engine = "CYCLES"
scene.render.threads_mode, scene.render.threads = "FIXED", threads
scene.cycles.device = "CPU"
scene.cycles.samples = samples
scene.cycles.use_adaptive_sampling = scene.cycles.use_denoising = scene.cycles.use_auto_tile = False
scene.world = bpy.data.worlds.new("World")
scene.world.light_settings.distance = 1e30

image = bpy.data.images.new("bake", resolution, resolution, float_buffer=True, is_data=True)
material = bpy.data.materials.new("bake")
material.use_nodes = True
target = material.node_tree.nodes.new("ShaderNodeTexImage")
target.image = image
material.node_tree.nodes.active = target
mesh.data.materials.clear()
mesh.data.materials.append(material)
mesh.select_set(True)
bpy.context.view_layer.objects.active = mesh

bpy.ops.object.bake(type="AO", margin=0, use_clear=True)
image.filepath_raw = output
image.file_format = "OPEN_EXR"
image.save()
