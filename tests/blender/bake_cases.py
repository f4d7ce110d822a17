# SPDX-License-Identifier: Apache-2.0
"""Bake, and what it refuses."""
import json
import os
import struct

import bpy
import numpy
import OpenImageIO
from scene import Case, STUDIO, channel, plane, preferences, select, wall, world


class Bake(Case):
    def test_two_objects_give_two_maps_that_see_each_other(self):
        self.settings.occluders = "SELECTED"
        floor, roof = plane(), plane("roof", 200, (0, 0, 0.01))
        select(floor, roof)
        bpy.ops.vmlight.bake()
        self.assertEqual(self.maps(), ["shot_floor_vismap.exr", "shot_roof_vismap.exr"])
        self.assertLess(channel(self.path("vmlight", "shot_floor_vismap.exr"), "visibility").max(), 0.01)
        self.assertEqual(channel(self.path("vmlight", "shot_roof_vismap.exr"), "visibility").min(), 1)
        self.assertEqual(floor.vmlight.vismap, "//vmlight/shot_floor_vismap.exr")
        self.assertEqual(floor.vmlight.uv_map, "UVMap")
        select(floor)
        bpy.ops.vmlight.bake()
        self.assertEqual(channel(self.path("vmlight", "shot_floor_vismap.exr"), "visibility").min(), 1)

    def test_all_that_is_visible_blocks_light_and_nothing_else(self):
        floor = plane()
        roof = plane("roof", 200, (0, 0, 0.01))
        collection = bpy.data.collections.new("prop")
        hidden = bpy.data.objects.new("prop", roof.data)
        hidden.location = (0, 0, 0.01)
        collection.objects.link(hidden)
        instance = bpy.data.objects.new("instance", None)
        instance.instance_type, instance.instance_collection = "COLLECTION", collection

        def visibility():
            select(floor)
            bpy.ops.vmlight.bake()
            return channel(self.path("vmlight", "shot_floor_vismap.exr"), "visibility").mean()

        self.assertLess(visibility(), 0.01)
        roof.hide_render = True
        self.assertEqual(visibility(), 1)
        roof.hide_render, roof.hide_viewport = False, True
        self.assertEqual(visibility(), 1)
        roof.hide_viewport, roof.visible_shadow = False, False
        self.assertEqual(visibility(), 1)
        self.scene.collection.objects.link(instance)
        self.assertLess(visibility(), 0.01)

    def test_modifiers_and_transforms_are_baked(self):
        # A ball that a modifier makes of a cube, turned, mirrored and far away: convex, so that it sees all.
        bpy.ops.mesh.primitive_cube_add(location=(500, -300, 200), rotation=(0.3, 0.4, 0.5))
        cube = bpy.context.object
        cube.scale = (-1, 1, 1)
        modifier = cube.modifiers.new("round", "SUBSURF")
        modifier.levels = 4
        for polygon in cube.data.polygons:
            polygon.use_smooth = True
        bpy.ops.vmlight.unwrap()
        bpy.ops.vmlight.bake()
        path = self.path("vmlight", "shot_Cube_vismap.exr")
        covered = channel(path, "coverage") > 0
        visibility = channel(path, "visibility")
        self.assertGreater(covered.sum(), 300)
        self.assertGreater(visibility[covered].min(), 0.9)
        self.assertGreater(visibility[covered].mean(), 0.99)

    def test_the_exported_mesh_is_blenders_to_the_bit(self):
        from vmlight_addon import glb, mesh_export
        bpy.ops.mesh.primitive_monkey_add(location=(1e4, 2, 3))
        monkey = bpy.context.object
        monkey.name = "\u00c4ffin"
        depsgraph = bpy.context.evaluated_depsgraph_get()
        parts, names = mesh_export.scene_parts(depsgraph, [monkey], ["UVMap"], False)
        self.assertEqual(names, ["\u00c4ffin"])
        glb.write(self.path("m.glb"), parts)
        with open(self.path("m.glb"), "rb") as file:
            data = file.read()
        length = struct.unpack_from("<I", data, 12)[0]
        tree, body = json.loads(data[20:20 + length]), data[28 + length:]
        self.assertEqual(struct.unpack_from("<I", data, 8)[0], len(data))

        def array(name):
            accessor = tree["accessors"][tree["meshes"][0]["primitives"][0]["attributes"][name]]
            view = tree["bufferViews"][accessor["bufferView"]]
            return numpy.frombuffer(body[view["byteOffset"]:view["byteOffset"] + view["byteLength"]], numpy.float32)

        loops = [loop.vertex_index for loop in monkey.data.loops]
        expected = numpy.array([monkey.data.vertices[i].co for i in loops], numpy.float32).ravel()
        self.assertTrue((array("POSITION") == expected).all())
        uvs = numpy.array([loop.uv for loop in monkey.data.uv_layers[0].data], numpy.float32)
        self.assertTrue((array("TEXCOORD_0").reshape(-1, 2)[:, 0] == uvs[:, 0]).all())
        self.assertLessEqual(numpy.abs(1 - array("TEXCOORD_0").reshape(-1, 2)[:, 1] - uvs[:, 1]).max(), 2 ** -25)
        self.assertEqual(tree["nodes"][1]["matrix"][12:], [1e4, 2, 3, 1])

    def test_materials_are_named(self):
        from vmlight_addon import mesh_export
        ob = plane()
        ob.data.materials.append(bpy.data.materials.new("red"))
        ob.data.materials.append(None)
        part = mesh_export.part_of_mesh(ob.data, "x", ob.matrix_world)
        self.assertEqual([(name, len(t)) for name, t in part.materials], [("red", 2)])
        ob.data.polygons[0].material_index = 1
        self.assertEqual([name for name, _ in mesh_export.part_of_mesh(ob.data, "x", ob.matrix_world).materials], [""])

    def test_the_map_is_makevismaps_own(self):
        # The wall is at -x of the floor: the left of the map sees less, and more to the right.
        floor = plane()
        wall()
        select(floor)
        bpy.ops.vmlight.bake()
        path = self.path("vmlight", "shot_floor_vismap.exr")
        self.assertEqual(OpenImageIO.ImageBuf(path).spec().get_string_attribute("vmlight:stage"), "vismap")
        visibility, x, y = (channel(path, name) for name in ("visibility", "direction.x", "direction.y"))
        self.assertLess(visibility[32, 1], 0.6)
        self.assertGreater(visibility[32, 62], 0.8)
        self.assertGreater(x[32, 1], 0.1)
        self.assertGreater(y[32, 62], 0.5)  # y is up


class Refusals(Case):
    def test_nothing_to_bake(self):
        self.assert_refused("no mesh is selected: select the objects to bake", bpy.ops.vmlight.bake)
        mesh = bpy.data.meshes.new("nothing")
        mesh.uv_layers.new()
        ob = bpy.data.objects.new("nothing", mesh)
        self.scene.collection.objects.link(ob)
        select(ob)
        self.assert_refused('"nothing" has no', bpy.ops.vmlight.bake)
        self.assert_refused('"nothing" has no faces, so nothing to unwrap', bpy.ops.vmlight.unwrap)

    def test_missing_uvs(self):
        ob = plane()
        self.settings.uv_source = "UNWRAPPED"
        self.assert_refused('"floor" has no UV map "vmlight": press Unwrap, or set UVs to Keep', bpy.ops.vmlight.bake)
        self.settings.uv_source = "KEEP"
        ob.data.uv_layers.remove(ob.data.uv_layers[0])
        self.assert_refused('"floor" has no UV map: press Unwrap', bpy.ops.vmlight.bake)
        self.assertEqual(self.maps(), [])

    def test_a_missing_executable_says_what_to_do(self):
        plane()
        preferences().folder = self.folder
        for operator in bpy.ops.vmlight.bake, bpy.ops.vmlight.unwrap:
            self.assert_refused("makevismap is not in", operator)
        preferences().folder = ""
        paths, os.environ["PATH"] = os.environ["PATH"], self.folder
        try:
            self.assert_refused("makevismap is not installed: install vmlight, and set its folder", bpy.ops.vmlight.bake)
        finally:
            os.environ["PATH"] = paths
        world(STUDIO)
        with open(self.path("makelightmap"), "w"):
            pass
        preferences().folder = self.folder
        self.assert_refused("vmframes is not in", bpy.ops.vmlight.turntable)
        self.assertEqual(self.maps(), [])

    def test_the_tools_words_are_reported(self):
        bpy.ops.mesh.primitive_monkey_add()
        self.assert_refused('"Suzanne": 17 charts do not fit into 64x64 texels with a margin of 16', bpy.ops.vmlight.unwrap)
        from vmlight_addon import status
        self.assertEqual(status.log[-1][0], "ERROR")
        self.assertNotIn("vmlight", bpy.context.object.data.uv_layers)
        for loop in bpy.context.object.data.uv_layers[0].data:
            loop.uv = (0.5, 0.5)
        bpy.ops.vmlight.bake()
        self.assertIn(("WARNING", "no texel centre is covered: the map is empty"), status.log)

    def test_edit_mode(self):
        plane()
        bpy.ops.object.mode_set(mode="EDIT")
        with self.assertRaises(RuntimeError):
            bpy.ops.vmlight.bake()
