# SPDX-License-Identifier: Apache-2.0
"""Where light comes from: a ball under three lamps of an environment, in Cycles with Blender's own World, and lit by us."""
import itertools
import math

import bpy
import mathutils
import numpy
import OpenImageIO
from scene import Case, render, select, world

HEIGHT = 64
# Row and column (of HEIGHT and twice that) and colour of each lamp: no rotation or mirror image of the three is the same.
LAMPS = ((12, 20, 0), (30, 70, 1), (45, 101, 2))
MAPPINGS = (((0, 0, 0), "POINT"), ((0, 0, 90), "POINT"), ((0, 0, -35), "TEXTURE"), ((50, 0, 0), "POINT"),
            ((0, -40, 0), "VECTOR"), ((20, 35, 110), "POINT"), ((20, 35, 110), "TEXTURE"), ((70, -20, 5), "NORMAL"))
# From the side, and from below at an angle.
CAMERAS = tuple((place, (-mathutils.Vector(place)).to_track_quat("-Z", "Y").to_euler()) for place in ((5, 0, 0), (2, 3, -4)))


class Direction(Case):
    def lamps(self):
        """Discs of 14 pixels in radius on a dim ground, so that Cycles needs few samples."""
        rows, columns = numpy.mgrid[:HEIGHT, :2 * HEIGHT] + 0.5
        theta, phi = numpy.pi * rows / HEIGHT, numpy.pi * columns / HEIGHT
        directions = numpy.stack([numpy.sin(theta) * numpy.cos(phi), numpy.sin(theta) * numpy.sin(phi), numpy.cos(theta)], -1)
        values = numpy.full((HEIGHT, 2 * HEIGHT, 3), 0.05, numpy.float32)
        for row, column, channel in LAMPS:
            values[directions @ directions[row, column] > math.cos(0.6), channel] = 3
        image = OpenImageIO.ImageBuf(OpenImageIO.ImageSpec(2 * HEIGHT, HEIGHT, 3, OpenImageIO.FLOAT))
        image.set_pixels(OpenImageIO.ROI(), values)
        self.assertTrue(image.write(self.path("lamps.exr")))
        return self.path("lamps.exr")

    def ball(self):
        bpy.ops.mesh.primitive_uv_sphere_add(segments=96, ring_count=48, radius=0.95)
        ball = bpy.context.object
        bpy.ops.object.shade_smooth()
        white = bpy.data.materials.new("white")
        white.use_nodes = True
        tree = white.node_tree
        tree.nodes.clear()
        diffuse, output = tree.nodes.new("ShaderNodeBsdfDiffuse"), tree.nodes.new("ShaderNodeOutputMaterial")
        diffuse.inputs["Color"].default_value = (1, 1, 1, 1)
        tree.links.new(diffuse.outputs[0], output.inputs["Surface"])
        ball.data.materials.append(white)
        select(ball)
        self.settings.resolution = 256
        bpy.ops.vmlight.bake()
        return ball

    def compare(self, ball, camera):
        """Mean and largest difference on the ball, relative to the brightest light."""
        location, rotation = camera
        if ball.vmlight.applied:
            bpy.ops.vmlight.restore()
        theirs = render(self.path("theirs.exr"), 32, 256, location, rotation)
        bpy.ops.vmlight.apply()
        ours = render(self.path("ours.exr"), 32, 1, location, rotation)
        rows, columns = numpy.mgrid[:32, :32] - 15.5
        inside = numpy.hypot(rows, columns) < 14
        error = numpy.abs(ours - theirs)[inside]
        return error.mean() / theirs[inside].max(), error.max() / theirs[inside].max()

    def assert_lit_alike(self, ball):
        for camera in CAMERAS:
            mean, largest = self.compare(ball, camera)
            self.assertLess(mean, 0.01)
            self.assertLess(largest, 0.08)  # noise of 256 samples

    def test_light_comes_from_where_cycles_has_it(self):
        ball, lamps = self.ball(), self.lamps()
        for angles, kind in MAPPINGS:
            with self.subTest(angles=angles, kind=kind):
                world(lamps, [math.radians(angle) for angle in angles], kind)
                self.assert_lit_alike(ball)

    def test_without_a_mapping_and_after_the_ball_was_turned(self):
        ball, lamps = self.ball(), self.lamps()
        world(lamps)
        self.assert_lit_alike(ball)
        ball.rotation_euler = (0.3, 0.7, -1.2)
        bpy.context.view_layer.update()
        self.assert_lit_alike(ball)

    def test_a_wrong_quarter_turn_would_be_noticed(self):
        ball, lamps = self.ball(), self.lamps()
        world(lamps, (0, 0, 0))
        bpy.ops.vmlight.apply()
        bpy.ops.vmlight.restore()
        for axis, degrees in itertools.product(range(3), (90, 180)):
            angles = [0, 0, 0]
            angles[axis] = math.radians(degrees)
            theirs = render(self.path("theirs.exr"), 32, 16, *CAMERAS[0])
            self.settings.follow_world = True
            self.scene.world.node_tree.nodes["Mapping"].inputs["Rotation"].default_value = angles
            bpy.ops.vmlight.apply()
            ours = render(self.path("ours.exr"), 32, 1, *CAMERAS[0])
            bpy.ops.vmlight.restore()
            self.scene.world.node_tree.nodes["Mapping"].inputs["Rotation"].default_value = (0, 0, 0)
            rows, columns = numpy.mgrid[:32, :32] - 15.5
            inside = numpy.hypot(rows, columns) < 14
            self.assertGreater(numpy.abs(ours - theirs)[inside].mean() / theirs[inside].max(), 0.03, (axis, degrees))
