# SPDX-License-Identifier: Apache-2.0
"""Relight, Apply, Restore; pictures against the lit texture; the World that is followed."""
import math
import os
import shlex
import stat
import subprocess

import bpy
import numpy
from scene import BIN, Case, STUDIO, material, pixels, plane, preferences, read, render, select, wall, world

SKY = STUDIO.replace("studio_small_03", "kloppenheim_05")


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


class Relight(Lit):
    def test_the_texture_is_makelightmaps_to_the_bit(self):
        floor = self.floor()
        bpy.ops.vmlight.relight()
        from vmlight_addon import status
        self.assertEqual(status.light_note, "by the reader")
        self.assertTrue((pixels(floor.vmlight.image) == self.expected("--rotate", "0,-90,0")).all())
        self.assertEqual(floor.vmlight.image.colorspace_settings.name, "Linear" if bpy.app.version < (4,) else "Linear Rec.709")

    def test_sliders_relight_in_place(self):
        floor = self.floor()
        self.settings.follow_world = False
        self.settings.environment = STUDIO
        self.settings.rotation = math.radians(135)  # as Z of a Mapping node: 90 is none of ours
        image = floor.vmlight.image
        self.assert_near(pixels(image), self.expected("--rotate", "0,45,0"), 1e-5)
        self.settings.exposure = 1.5
        self.assertEqual(floor.vmlight.image, image)
        self.assert_near(pixels(image), self.expected("--rotate", "0,45,0", "--exposure", "1.5"), 1e-5)
        self.settings.model = "ao"
        ao = self.expected("--rotate", "0,45,0", "--exposure", "1.5", "--model", "ao")
        self.assert_near(pixels(image), ao, 1e-5)

    def test_the_world_is_followed(self):
        floor = self.floor()
        tree = world(STUDIO, (0, 0, math.radians(90)), strength=4).node_tree
        bpy.ops.vmlight.relight()
        self.assert_near(pixels(floor.vmlight.image), self.expected("--exposure", "2"), 1e-5)
        # A change of its nodes alone is noticed.
        tree.nodes["Mapping"].inputs["Rotation"].default_value = (0, 0, 0)
        bpy.context.view_layer.update()
        self.assert_near(pixels(floor.vmlight.image), self.expected("--exposure", "2", "--rotate", "0,-90,0"), 1e-5)

    def test_the_images_colour_space_is_followed(self):
        floor = self.floor()
        from vmlight_addon import light, render_pixels, status
        image = next(node.image for node in self.scene.world.node_tree.nodes if node.type == "TEX_ENVIRONMENT")
        for space, ours in ("Non-Color", "lin_rec709_scene"), ("Linear ACEScg", "lin_ap1_scene"):
            image.colorspace_settings.name = space
            if ours == "lin_ap1_scene":  # saturated light is negative in Rec.709
                self.assert_refused("values that are negative, the first at pixel (198, 51) channel \"R\"; turn on Repair "
                                    "Environment to repair them", bpy.ops.vmlight.relight)
                render_pixels.reader_fault = "a test says so"
                light.refresh(self.scene)
                self.assertIn("turn on Repair Environment", status.light_faults[0])
                self.settings.repair = True
            bpy.ops.vmlight.relight()
            lit = self.expected("--rotate", "0,-90,0", "--colorspace", ours, "--cfem-sanitize")
            self.assert_near(pixels(floor.vmlight.image), lit, 1e-5)
        image.colorspace_settings.name = "Filmic Log"
        self.assert_refused('colour space "Filmic Log" is unknown to vmlight', bpy.ops.vmlight.relight)

    def test_a_world_of_one_colour_is_ambient_occlusion(self):
        floor = self.floor()
        self.scene.world = bpy.data.worlds.new("grey")
        self.scene.world.use_nodes = True
        background = self.scene.world.node_tree.nodes["Background"]
        background.inputs["Color"].default_value, background.inputs["Strength"].default_value = (0.1, 0.2, 0.4, 1), 2
        bpy.ops.vmlight.relight()
        lit = pixels(floor.vmlight.image)
        from scene import channel
        visibility = channel(self.path("vmlight", "shot_floor_vismap.exr"), "visibility")
        self.assert_near(lit, visibility[..., None] * numpy.array([0.2, 0.4, 0.8], numpy.float32), 1e-4)

    def test_worlds_that_cannot_be_followed_say_why(self):
        self.floor()
        tree = self.scene.world.node_tree
        texture, background = tree.nodes["Environment Texture"], tree.nodes["Background"]

        def refused(text):
            self.assert_refused(text, bpy.ops.vmlight.relight)

        texture.projection = "MIRROR_BALL"
        refused('World "sky": its Environment Texture is a mirror ball')
        texture.projection = "EQUIRECTANGULAR"
        background.inputs["Strength"].default_value = -1
        refused("Strength of its Background is -1")
        background.inputs["Strength"].default_value = 1
        bpy.ops.vmlight.add_mapping()
        mapping = tree.nodes["Mapping"]
        bpy.ops.vmlight.relight()
        mapping.inputs["Scale"].default_value = (1, 1, -1)
        refused("its Mapping node scales the map by 1, 1, -1: set Scale to 1")
        mapping.inputs["Scale"].default_value = (1, 1, 1)
        tree.links.new(tree.nodes["Texture Coordinate"].outputs["Window"], mapping.inputs["Vector"])
        refused('looked up by the node "Texture Coordinate"')
        tree.links.new(tree.nodes["Texture Coordinate"].outputs["Generated"], mapping.inputs["Vector"])
        hue = tree.nodes.new("ShaderNodeHueSaturation")
        tree.links.new(texture.outputs[0], hue.inputs["Color"])
        tree.links.new(hue.outputs[0], background.inputs["Color"])
        refused("comes from the node \"Hue Saturation Value\"")
        texture.image = None
        tree.links.new(texture.outputs[0], background.inputs["Color"])
        refused("has no image: open one")
        tree.nodes.clear()
        refused("link a Background")
        self.scene.world = None
        refused("the scene has no World")
        self.settings.follow_world = False
        refused("no environment: choose a file")
        self.settings.environment = "//none.hdr"
        refused('none.hdr": no such file')

    def test_the_side_that_the_camera_does_not_see_lights(self):
        floor = self.floor()
        tree = self.scene.world.node_tree
        mix, path, black = (tree.nodes.new("ShaderNode" + kind) for kind in ("MixShader", "LightPath", "Background"))
        tree.links.new(path.outputs["Is Camera Ray"], mix.inputs[0])
        tree.links.new(tree.nodes["Background"].outputs[0], mix.inputs[1])
        tree.links.new(black.outputs[0], mix.inputs[2])
        tree.links.new(mix.outputs[0], tree.nodes["World Output"].inputs["Surface"])
        bpy.ops.vmlight.relight()
        self.assert_near(pixels(floor.vmlight.image), self.expected("--rotate", "0,-90,0"), 1e-5)

    def test_without_openimageio_makelightmap_does_it(self):
        floor = self.floor()
        bpy.ops.vmlight.relight()
        by_reader = pixels(floor.vmlight.image)
        from vmlight_addon import light, render_pixels, status
        render_pixels.reader_fault = "a test says so"
        light.refresh(self.scene, force=True)
        self.assertEqual((status.light_note, status.light_faults), ("by makelightmap: a test says so", []))
        self.assert_near(pixels(floor.vmlight.image), by_reader, 1e-6)

    def test_a_missing_map_is_named(self):
        self.floor()
        os.remove(self.path("vmlight", "shot_floor_vismap.exr"))
        self.assert_refused('shot_floor_vismap.exr": no such file: bake again', bpy.ops.vmlight.relight)

    def test_saved_files_keep_the_light(self):
        floor = self.floor()
        bpy.ops.vmlight.apply()
        before = pixels(floor.vmlight.image)
        self.save()
        bpy.ops.wm.open_mainfile(filepath=self.path("shot.blend"))
        floor = bpy.data.objects["floor"]
        self.assertTrue((pixels(floor.vmlight.image) == before).all())
        select(floor)
        bpy.ops.vmlight.restore()
        self.assertEqual(len(floor.data.materials), 0)

    def test_match_exposure_brings_the_mean_to_middle_grey(self):
        floor = self.floor()
        bpy.ops.vmlight.match_exposure()
        mean = (pixels(floor.vmlight.image).astype(float) @ (0.2126, 0.7152, 0.0722)).mean()
        self.assertAlmostEqual(mean, 0.18, 4)

    def test_the_copied_command_makes_the_same(self):
        floor = self.floor()
        bpy.ops.vmlight.relight()
        from vmlight_addon import light
        words = light.command(floor, self.scene)
        subprocess.run([os.path.join(BIN, words[0]), *words[1:], "--quiet"], check=True, cwd=self.folder)
        self.assertTrue((read(self.path("floor_lit.exr")) == pixels(floor.vmlight.image)).all())


class Apply(Lit):
    """A pixel a texel, at their centres."""

    def picture(self):
        for made in bpy.data.materials:
            for node in made.node_tree.nodes:
                if node.type == "TEX_IMAGE":
                    node.interpolation = "Closest"
        return render(self.path("picture.exr"), 64)

    def test_the_picture_is_the_texture(self):
        floor = self.floor()
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
