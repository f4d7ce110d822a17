#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""The set-up of the paper's Figure 1: seconds a frame to light and to render, and Cycles beside it:

  bench/figure_one.py MESH ENVIRONMENT [--map 1024] [--size 1024] [--spp 16] [--frames 8] [--no-cycles]

The mesh turns once around in the environment, with a map that is baked once before. Executables are those in $VMLIGHT_BIN,
else in build/release/bin. Where Blender is installed, Cycles renders the first frame (a white diffuse surface under the same
environment, without bounces) with more and more samples, until its relative RMS against a picture of its own with --truth samples is that
of vmframes' picture against the same; the ratio of times is printed. What is left of noise in the truth is taken out of all
errors. Nothing else should run meanwhile."""
import argparse
import os
import re
import shutil
import subprocess
import sys
import tempfile

import numpy
import OpenImageIO as oiio

HERE = os.path.dirname(os.path.abspath(__file__))
BIN = os.environ.get("VMLIGHT_BIN", os.path.join(HERE, "../build/release/bin"))

# Run in Blender: the same camera, mesh and environment. Its world is z up, and turned by 90 degrees.
BLENDER = """
import bpy, math, sys, time
from mathutils import Matrix
mesh, environment, size, places, target, samples = sys.argv[sys.argv.index("--") + 1:]
position, right, up, back, half = eval(places)
bpy.ops.wm.read_factory_settings(use_empty=True)
scene = bpy.context.scene
bpy.ops.wm.obj_import(filepath=mesh, forward_axis="NEGATIVE_Z", up_axis="Y")
material = bpy.data.materials.new("white")
material.use_nodes = True
nodes = material.node_tree.nodes
nodes.clear()
diffuse, output = nodes.new("ShaderNodeBsdfDiffuse"), nodes.new("ShaderNodeOutputMaterial")
diffuse.inputs["Color"].default_value = (1, 1, 1, 1)
material.node_tree.links.new(diffuse.outputs[0], output.inputs["Surface"])
for thing in scene.objects:
    thing.data.materials.clear()
    thing.data.materials.append(material)
world = bpy.data.worlds.new("world")
world.use_nodes = True
scene.world = world
tree = world.node_tree
coordinates, mapping = tree.nodes.new("ShaderNodeTexCoord"), tree.nodes.new("ShaderNodeMapping")
image = tree.nodes.new("ShaderNodeTexEnvironment")
image.image = bpy.data.images.load(environment)
mapping.inputs["Rotation"].default_value = (0, 0, math.radians(90))
tree.links.new(coordinates.outputs["Generated"], mapping.inputs["Vector"])
tree.links.new(mapping.outputs[0], image.inputs["Vector"])
tree.links.new(image.outputs[0], tree.nodes["Background"].inputs[0])
camera = bpy.data.cameras.new("camera")
holder = bpy.data.objects.new("camera", camera)
scene.collection.objects.link(holder)
scene.camera = holder
camera.sensor_fit = "VERTICAL"
camera.angle_y = 2 * math.atan(half)
turn = lambda v: (v[0], -v[2], v[1])
axes = [turn(right), turn(up), turn(back), turn(position)]
holder.matrix_world = Matrix([[axis[row] for axis in axes] for row in range(3)] + [[0, 0, 0, 1]])
scene.render.engine = "CYCLES"
scene.cycles.max_bounces = 0
scene.cycles.use_denoising = False
scene.cycles.use_adaptive_sampling = False
scene.render.film_transparent = True
scene.render.resolution_x = scene.render.resolution_y = int(size)
scene.render.image_settings.file_format = "OPEN_EXR"
scene.render.image_settings.color_depth = "32"
scene.view_settings.view_transform = "Raw"
for count in samples.split(","):
    scene.cycles.samples = int(count)
    scene.render.filepath = target + count + ".exr"
    begin = time.perf_counter()
    bpy.ops.render.render(write_still=True)
    print("SECONDS", count, time.perf_counter() - begin)
"""


def run(*words):
    done = subprocess.run(words, capture_output=True, text=True)
    if done.returncode:
        sys.exit(f"{' '.join(words)}\n{done.stdout}{done.stderr}")
    return done.stdout + done.stderr


def pixels(path):
    image = oiio.ImageBuf(path)
    names = list(image.spec().channelnames)
    return image.get_pixels(oiio.FLOAT)[:, :, [names.index(name) for name in "RGBA"]]


def relative_rms(picture, truth, noise=0.0):
    """@param noise: the relative RMS of the truth itself, which is independent of the picture's error"""
    seen = truth[:, :, 3] >= 1 # edges are a matter of the filter
    difference = (picture - truth)[seen][:, :3]
    return max(float((difference ** 2).mean()) / float(truth[seen][:, :3].mean()) ** 2 - noise ** 2, 0) ** 0.5


def cycles(options, folder, camera, samples):
    """{samples: (seconds, picture)}"""
    script = os.path.join(folder, "cycles.py")
    with open(script, "w") as file:
        file.write(BLENDER)
    text = run("blender", "-b", "--factory-startup", "-P", script, "--", os.path.abspath(options.mesh),
               os.path.abspath(options.environment), str(options.size), repr(camera), os.path.join(folder, "cycles_"),
               ",".join(map(str, samples)))
    return {int(count): (float(seconds), pixels(os.path.join(folder, f"cycles_{count}.exr")))
            for count, seconds in re.findall(r"SECONDS (\d+) ([\d.]+)", text)}


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("mesh")
    parser.add_argument("environment")
    for name, value in (("map", 1024), ("size", 1024), ("spp", 16), ("frames", 8), ("truth", 512)):
        parser.add_argument("--" + name, type=int, default=value)
    parser.add_argument("--models", default="paper,lobe,sh,cells")
    parser.add_argument("--no-cycles", action="store_true")
    options = parser.parse_args()

    with tempfile.TemporaryDirectory() as folder:
        vmframes = os.path.join(BIN, "vmframes")
        common = [vmframes, options.mesh, options.environment, "--white", "--size", str(options.size), "--resolution",
                  str(options.map), "--spp", str(options.spp)]
        pictures = {}
        print(f"{'model':8} {'light, s':>9} {'render, s':>10} {'frame, s':>9}")
        for model in options.models.split(","):
            text = run(*common, "--model", model, "--frames", f"1-{options.frames}", "--turntable", "-o",
                       os.path.join(folder, model + ".#.exr"))
            light, render = map(float, re.search(r"took ([\d.]+) s to light and ([\d.]+) s to render", text).groups())
            pictures[model] = (light + render, pixels(os.path.join(folder, model + ".1.exr")))
            print(f"{model:8} {light:9.3f} {render:10.3f} {light + render:9.3f}")
        if options.no_cycles or not shutil.which("blender"):
            print("Cycles: left out" + ("" if options.no_cycles else ": Blender is not installed"))
            return
        if not options.mesh.endswith(".obj"):
            sys.exit("Cycles reads the mesh as an .obj here")
        one = oiio.ImageBuf(os.path.join(folder, options.models.split(",")[0] + ".1.exr")).spec()
        camera = eval(one.get_string_attribute("vmlight:camera"))
        counts = [1, 2, 4, 8, 16, 32, 64]
        rendered = cycles(options, folder, camera, counts + [options.truth])
        truth = rendered[options.truth][1]
        # Variances fall as one over the samples.
        noise = relative_rms(rendered[counts[-1]][1], truth) / (1 + options.truth / counts[-1]) ** 0.5
        errors = {count: relative_rms(rendered[count][1], truth, noise) for count in counts}
        print(f"\nCycles' truth has {options.truth} samples and a relative RMS of {noise:.4f}")
        print(f"{'Cycles':8} {'seconds':>9} {'RMS':>8}")
        for count in counts:
            print(f"{count:8} {rendered[count][0]:9.2f} {errors[count]:8.4f}")
        print(f"\n{'model':8} {'seconds':>9} {'RMS':>8}  Cycles takes")
        for model, (seconds, picture) in pictures.items():
            error = relative_rms(picture, truth, noise)
            equal = next((count for count in counts if errors[count] <= error), None)
            words = f"{rendered[equal][0] / seconds:.1f} times as long ({equal} samples)" if equal else f"more than {counts[-1]} samples"
            print(f"{model:8} {seconds:9.3f} {error:8.4f}  {words}")


if __name__ == "__main__":
    main()
