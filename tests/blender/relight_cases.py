# SPDX-License-Identifier: Apache-2.0
"""Relight: lit textures, the World that is followed, saved files."""
import math
import os
import subprocess

import bpy
import numpy
from scene import BIN, Lit, STUDIO, channel, pixels, read, select, world


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
