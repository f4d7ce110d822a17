# SPDX-License-Identifier: Apache-2.0
"""Scenes for the cases that run in Blender."""
import os
import shutil
import subprocess
import tempfile
import unittest

import bpy
import numpy
import OpenImageIO

DATA = os.path.join(os.environ["VMLIGHT_SOURCE"], "tests/data")
STUDIO = os.path.join(DATA, "studio_small_03.hdr")
BIN = os.environ["VMLIGHT_BIN"]


class Case(unittest.TestCase):
    """An empty scene for each test, saved in a folder of its own."""

    def setUp(self):
        bpy.ops.wm.read_homefile(use_factory_startup=True, use_empty=True)
        preferences().folder = BIN
        self.folder = tempfile.mkdtemp(prefix="case-", dir=os.environ["VMLIGHT_FOLDER"])
        self.addCleanup(shutil.rmtree, self.folder, ignore_errors=True)
        self.save()
        from vmlight_addon import render_pixels, status
        status.log.clear()
        status.light_faults = []
        render_pixels.forget()
        self.settings.resolution, self.settings.samples = 64, 64

    @property
    def scene(self):
        return bpy.context.scene

    @property
    def settings(self):
        return bpy.context.scene.vmlight

    def path(self, *names):
        return os.path.join(self.folder, *names)

    def save(self):
        bpy.ops.wm.save_as_mainfile(filepath=self.path("shot.blend"))

    def maps(self):
        return sorted(os.listdir(self.path("vmlight"))) if os.path.isdir(self.path("vmlight")) else []

    def assert_refused(self, text, operator, *arguments):
        """An operator that reports an error raises it in a script."""
        with self.assertRaises(RuntimeError) as seen:
            operator(*arguments)
        self.assertIn(text, str(seen.exception))

    def run_tool(self, name, *words):
        subprocess.run([os.path.join(BIN, name), *words, "--quiet"], check=True)


def preferences():
    return bpy.context.preferences.addons["vmlight_addon"].preferences


def select(*objects):
    bpy.ops.object.select_all(action="DESELECT")
    for ob in objects:
        ob.select_set(True)
    bpy.context.view_layer.objects.active = objects[0]


def plane(name="floor", size=2, location=(0, 0, 0)):
    """With UVs over the whole map."""
    bpy.ops.mesh.primitive_plane_add(size=size, location=location)
    bpy.context.object.name = name
    return bpy.context.object


def wall():
    """A black wall of half the floor's width, on its side at -x. Only a camera above sees past it."""
    mesh = bpy.data.meshes.new("wall")
    mesh.from_pydata([(-1, -1, 0), (-1, -1, 1), (-1, 1, 1), (-1, 1, 0)], [], [(0, 1, 2, 3)])
    ob = bpy.data.objects.new("wall", mesh)
    bpy.context.scene.collection.objects.link(ob)
    return ob


def world(image_path, radians=None, kind="POINT", strength=1.0):
    """A World that shows a map. @param radians: of a Mapping node; None for none"""
    bpy.context.scene.world = bpy.data.worlds.new("sky")
    bpy.context.scene.world.use_nodes = True
    tree = bpy.context.scene.world.node_tree
    texture = tree.nodes.new("ShaderNodeTexEnvironment")
    texture.image = bpy.data.images.load(image_path)
    background = tree.nodes["Background"]
    background.inputs["Strength"].default_value = strength
    tree.links.new(texture.outputs["Color"], background.inputs["Color"])
    if radians is not None:
        coordinate, mapping = tree.nodes.new("ShaderNodeTexCoord"), tree.nodes.new("ShaderNodeMapping")
        mapping.vector_type = kind
        mapping.inputs["Rotation"].default_value = radians
        tree.links.new(coordinate.outputs["Generated"], mapping.inputs["Vector"])
        tree.links.new(mapping.outputs["Vector"], texture.inputs["Vector"])
    return bpy.context.scene.world


def material(name, color, alpha=1.0):
    made = bpy.data.materials.new(name)
    made.use_nodes = True
    shader = made.node_tree.nodes["Principled BSDF"]
    shader.inputs["Base Color"].default_value = (*color, 1)
    shader.inputs["Alpha"].default_value = alpha
    return made


def pixels(image):
    """Of a Blender image: rows from the top, R, G, B."""
    values = numpy.empty(len(image.pixels), numpy.float32)
    image.pixels.foreach_get(values)
    return values.reshape(image.size[1], image.size[0], -1)[::-1, :, :3]


def read(path, names=("R", "G", "B")):
    """Channels of a file. (ImageBuf may hold what the file was a moment before: its cache counts in seconds.)"""
    image = OpenImageIO.ImageInput.open(path)
    spec = image.spec()
    values = image.read_image(OpenImageIO.FLOAT)
    image.close()
    return values[..., [spec.channelindex(name) for name in names]]


def channel(path, name):
    return read(path, [name])[..., 0]


def render(path, resolution, samples=1, location=(0, 0, 5), rotation=(0, 0, 0), size=2):
    """What an orthographic camera sees, in the working space: rows from the top, R, G, B."""
    scene = bpy.context.scene
    if scene.world:  # to prepare the full size takes longer than the picture
        scene.world.cycles.sampling_method, scene.world.cycles.sample_map_resolution = "MANUAL", 128
    scene.render.engine = "CYCLES"
    scene.cycles.device, scene.cycles.samples, scene.cycles.seed = "CPU", samples, 1
    scene.cycles.use_denoising = scene.cycles.use_adaptive_sampling = False
    scene.cycles.pixel_filter_type, scene.cycles.filter_width = "BOX", 0.01  # rays through the pixels' centres
    scene.render.resolution_x = scene.render.resolution_y = resolution
    scene.render.image_settings.file_format, scene.render.image_settings.color_depth = "OPEN_EXR", "32"
    scene.view_settings.view_transform = "Raw"
    if scene.camera is None:
        scene.camera = bpy.data.objects.new("camera", bpy.data.cameras.new("camera"))
        scene.collection.objects.link(scene.camera)
    scene.camera.data.type, scene.camera.data.ortho_scale = "ORTHO", size
    scene.camera.location, scene.camera.rotation_euler = location, rotation
    scene.render.filepath = path
    bpy.ops.render.render(write_still=True)
    return read(path)


class Lit(Case):
    def floor(self):
        """Beside a wall, baked, under the studio."""
        floor = plane()
        wall()
        select(floor)
        bpy.ops.vmlight.bake()
        world(STUDIO)
        return floor

    def expected(self, *words):
        """Of makelightmap itself."""
        self.run_tool("makelightmap", self.path("vmlight", "shot_floor_vismap.exr"), STUDIO, "-o", self.path("lit.exr"), *words)
        return read(self.path("lit.exr"))

    def assert_near(self, a, b, bound):
        """Relative to the mean."""
        self.assertEqual(a.shape, b.shape)
        self.assertLess(numpy.abs(a - b).max() / numpy.abs(b).mean(), bound)
