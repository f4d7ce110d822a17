# SPDX-License-Identifier: Apache-2.0
"""Where light comes from: a ball under three lamps of an environment, in Cycles with Blender's own World, and lit by us."""
import math

import bpy
import mathutils
import numpy
import OpenImageIO
from scene import Case, render, select, world

HEIGHT = 64
SIZE = 32  # of the pictures
# Row and column (of HEIGHT and twice that) and colour of each lamp: no rotation or mirror image of the three is the same.
LAMPS = ((12, 20, 0), (30, 70, 1), (45, 101, 2))
MAPPINGS = (((0, 0, 90), "POINT"), ((50, 0, 0), "POINT"), ((0, -40, 0), "VECTOR"), ((20, 35, 110), "POINT"),
            ((20, 35, 110), "TEXTURE"), ((70, -20, 5), "NORMAL"))
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

    @staticmethod
    def error(ours, theirs):
        """On the ball, relative to the brightest light: the mean of how far they are apart, and the mean of the
        difference, which is free of noise, of the channel where it is largest."""
        rows, columns = numpy.mgrid[:SIZE, :SIZE] - (SIZE - 1) / 2
        inside = numpy.hypot(rows, columns) < 0.43 * SIZE
        error = (ours - theirs)[inside] / theirs[inside].max()
        return numpy.abs(error).mean(), numpy.abs(error.mean(axis=0)).max()

    def theirs(self, ball, camera):
        if ball.vmlight.applied:
            bpy.ops.vmlight.restore()
        return render(self.path("theirs.exr"), SIZE, 128, *camera)

    def ours(self, camera):
        bpy.ops.vmlight.apply()
        return render(self.path("ours.exr"), SIZE, 1, *camera)

    def assert_lit_alike(self, ball, camera):
        apart, bias = self.error(self.ours(camera), self.theirs(ball, camera))
        print(f"apart {apart:.4f}, bias {bias:.4f}")
        self.assertLess(apart, 0.015)  # noise of 128 samples: 0.006 to 0.009
        self.assertLess(bias, 0.003)

    def test_light_comes_from_where_cycles_has_it(self):
        ball, lamps = self.ball(), self.lamps()
        for number, (angles, kind) in enumerate(MAPPINGS):
            with self.subTest(angles=angles, kind=kind):
                world(lamps, [math.radians(angle) for angle in angles], kind)
                self.assert_lit_alike(ball, CAMERAS[number % 2])

    def test_without_a_mapping_and_after_the_ball_was_turned(self):
        ball, lamps = self.ball(), self.lamps()
        world(lamps)
        self.assert_lit_alike(ball, CAMERAS[0])
        ball.rotation_euler = (0.3, 0.7, -1.2)
        bpy.context.view_layer.update()
        self.assert_lit_alike(ball, CAMERAS[1])

    def test_a_wrong_quarter_turn_would_be_noticed(self):
        ball, lamps = self.ball(), self.lamps()
        rotation = world(lamps, (0, 0, 0)).node_tree.nodes["Mapping"].inputs["Rotation"]
        theirs = self.theirs(ball, CAMERAS[0])
        for axis in range(3):
            angles = [0, 0, 0]
            angles[axis] = math.radians(90)
            rotation.default_value = angles
            self.assertGreater(self.error(self.ours(CAMERAS[0]), theirs)[0], 0.05, axis)
