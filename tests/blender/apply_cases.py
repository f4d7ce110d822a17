# SPDX-License-Identifier: Apache-2.0
"""Apply and Restore; pictures against the lit texture; animations and turntables."""
import math
import os
import shlex
import stat

import bpy
import numpy
from scene import Lit, STUDIO, material, pixels, plane, preferences, read, render, select, world


class Apply(Lit):
    """A pixel a texel, at their centres."""

    def picture(self):
        for made in bpy.data.materials:
            for node in made.node_tree.nodes:
                if node.type == "TEX_IMAGE":
                    node.interpolation = "Closest"
        return render(self.path("picture.exr"), 64)

    def test_the_picture_is_the_texture(self):
        self.floor()
        bpy.ops.vmlight.apply()
        self.assert_near(self.picture(), self.expected("--rotate", "0,-90,0"), 1e-6)

    def test_between_texels_it_is_what_vmframes_looks_up(self):
        self.floor()
        bpy.ops.vmlight.apply()
        with open(self.path("floor.obj"), "w", encoding="utf-8") as file:
            file.write("v -1 0 1\nv 1 0 1\nv 1 0 -1\nv -1 0 -1\nvt 0 0\nvt 1 0\nvt 1 1\nvt 0 1\nf 1/1 2/2 3/3 4/4\n")
        self.expected("--rotate", "0,-90,0")
        self.run_tool("vmframes", self.path("floor.obj"), "--texture", self.path("lit.exr"), "--fov", "0", "--fill", "1",
                      "--elevation", "90", "--size", "200", "--spp", "1", "--filter", "box", "-o", self.path("looked_up.exr"))
        border = 3 # pixels: Cycles repeats the texture there
        inside = (slice(border, -border), slice(border, -border))
        self.assert_near(render(self.path("picture.exr"), 200)[inside], read(self.path("looked_up.exr"))[inside], 1e-3)

    def test_several_materials_keep_their_colours_and_come_back(self):
        floor = self.floor()
        red, blue = material("red", (0.8, 0.2, 0.1)), material("blue", (0.1, 0.2, 0.8))
        floor.data.materials.append(red)
        floor.data.materials.append(blue)
        select(floor)
        bpy.ops.object.mode_set(mode="EDIT")
        bpy.ops.mesh.subdivide()
        bpy.ops.object.mode_set(mode="OBJECT")
        for polygon in floor.data.polygons:
            polygon.material_index = int(polygon.center.x > 0)
        bpy.ops.vmlight.apply()
        color = numpy.empty((64, 64, 3), numpy.float32)
        color[:, :32], color[:, 32:] = (0.8, 0.2, 0.1), (0.1, 0.2, 0.8)
        self.assert_near(self.picture(), self.expected("--rotate", "0,-90,0") * color, 1e-6)
        self.assertEqual(list(floor.data.materials), [red, blue])  # the mesh is not touched
        bpy.ops.vmlight.apply()  # again is the same
        self.assertEqual(len(floor.vmlight.slots), 2)
        bpy.ops.vmlight.restore()
        self.assertEqual([(slot.material, slot.link) for slot in floor.material_slots], [(red, "DATA"), (blue, "DATA")])
        self.assertEqual({made.name for made in bpy.data.materials}, {"red", "blue"})

    def test_materials_of_the_object_come_back(self):
        floor = self.floor()
        shared, own = material("shared", (1, 1, 1)), material("own", (1, 1, 1))
        floor.data.materials.append(shared)
        floor.material_slots[0].link = "OBJECT"
        floor.material_slots[0].material = own
        bpy.ops.vmlight.apply()
        bpy.ops.vmlight.restore()
        slot = floor.material_slots[0]
        self.assertEqual((slot.link, slot.material, floor.data.materials[0]), ("OBJECT", own, shared))

    def test_objects_that_share_a_mesh_are_lit_each(self):
        first = self.floor()
        second = first.copy()
        second.location, second.name = (5, 0, 0), "second"
        self.scene.collection.objects.link(second)
        select(first, second)
        bpy.ops.vmlight.bake()
        bpy.ops.vmlight.apply()
        images = [next(node.image for node in ob.material_slots[0].material.node_tree.nodes if node.type == "TEX_IMAGE")
                  for ob in (first, second)]
        self.assertEqual(images, [first.vmlight.image, second.vmlight.image])
        self.assertFalse((pixels(images[0]) == pixels(images[1])).all())
        select(first)
        bpy.ops.vmlight.restore()
        self.assertTrue(second.material_slots[0].material.name.startswith("second lit"))
        select(second)
        bpy.ops.vmlight.restore()
        self.assertEqual(len(first.data.materials), 0)
        self.assertFalse([made for made in bpy.data.materials if made.get("vmlight")])

    def test_cut_outs_stay_cut_out(self):
        floor = self.floor()
        floor.data.materials.append(material("veil", (1, 1, 1), alpha=0.25))
        bpy.ops.vmlight.apply()
        self.scene.world.node_tree.nodes["Background"].inputs["Strength"].default_value = 0  # after the light is made
        nodes = floor.material_slots[0].material.node_tree.nodes
        self.assertEqual(nodes["Mix Shader"].inputs[0].default_value, 0.25)

    def test_nothing_baked(self):
        plane()
        with self.assertRaisesRegex(RuntimeError, "No selected object is baked: press Bake"):
            bpy.ops.vmlight.apply()


class Animation(Lit):
    def test_a_world_that_turns_is_rendered_frame_by_frame(self):
        self.floor()
        rotation = world(STUDIO, (0, 0, math.radians(90))).node_tree.nodes["Mapping"].inputs["Rotation"]
        bpy.ops.vmlight.apply()
        rotation.keyframe_insert("default_value", frame=1)
        rotation.default_value = (0, 0, math.radians(180))
        rotation.keyframe_insert("default_value", frame=2)
        self.scene.frame_start, self.scene.frame_end = 1, 2
        self.scene.frame_set(1)
        render(self.path("warm.exr"), 64)
        self.scene.render.filepath = self.path("turn.")
        bpy.ops.render.render(animation=True)
        for frame, turn in ("0001", "0,0,0"), ("0002", "0,90,0"):
            with self.subTest(frame=frame):
                self.assert_near(read(self.path(f"turn.{frame}.exr")), self.expected("--rotate", turn), 1e-3)

    def test_an_object_that_turns_stays_under_the_same_sky(self):
        # By a quarter about the vertical: the sky turns the other way around it.
        floor = self.floor()
        world(STUDIO, (0, 0, math.radians(90)))
        floor.rotation_euler = (0, 0, math.radians(90))
        bpy.context.view_layer.update()
        bpy.ops.vmlight.relight()
        self.assert_near(pixels(floor.vmlight.image), self.expected("--rotate", "0,90,0"), 1e-5)


class Turntable(Lit):
    def test_vmframes_is_called_with_the_light_of_the_world(self):
        self.floor()
        world(STUDIO, (0, 0, math.radians(90)), strength=2)
        tools = self.path("bin")
        os.mkdir(tools)
        with open(os.path.join(tools, "vmframes"), "w") as file:
            file.write(f'#!/bin/sh\nprintf "%s\\n" "$@" > {shlex.quote(self.path("words"))}\ntest -s "$1"\n')
        os.chmod(os.path.join(tools, "vmframes"), stat.S_IRWXU)
        preferences().folder = tools
        self.scene.frame_start, self.scene.frame_end = 3, 7
        bpy.ops.vmlight.turntable()
        with open(self.path("words")) as file:
            words = file.read().split()
        self.assertEqual(words[1:], [STUDIO, "-o", self.path("turntable.####.png"), "--frames", "3-7", "--turntable",
                                     "--env-rotate", "0,0,0", "--exposure", "1", "--vismap",
                                     self.path("vmlight", "shot_floor_vismap.exr"), "--colorspace", "lin_rec709_scene"])
