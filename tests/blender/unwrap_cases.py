# SPDX-License-Identifier: Apache-2.0
"""Unwrap."""
import bpy
import numpy
from scene import Case, channel, plane, select


class Unwrap(Case):
    def monkey(self):
        bpy.ops.mesh.primitive_monkey_add()
        self.settings.resolution = 256
        return bpy.context.object

    def test_the_monkey_gets_charts_that_do_not_overlap(self):
        monkey = self.monkey()
        before = [tuple(vertex.co) for vertex in monkey.data.vertices]
        bpy.ops.vmlight.unwrap()
        self.assertEqual(self.settings.uv_source, "UNWRAPPED")
        self.assertEqual([layer.name for layer in monkey.data.uv_layers], ["UVMap", "vmlight"])
        self.assertTrue(monkey.data.uv_layers["UVMap"].active_render)  # its own textures stay where they are
        self.assertEqual([tuple(vertex.co) for vertex in monkey.data.vertices], before)
        from vmlight_addon import status
        bpy.ops.vmlight.bake()
        self.assertEqual([text for kind, text in status.log if kind == "WARNING"], [])
        self.assertTrue(any("0 texels are shared" in text for _, text in status.log), status.log)
        self.assertGreater(channel(self.path("vmlight", "shot_Suzanne_vismap.exr"), "coverage").mean(), 0.2)

    def test_faces_are_cut_only_where_charts_part_them(self):
        from vmlight_addon import glb, mesh_export, status, unwrap
        monkey = self.monkey()
        faces = len(monkey.data.polygons)
        atlases, set_uvs = [], unwrap.set_uvs

        def watched(mesh, atlas):
            atlases.append(glb.read_uvs(atlas).reshape(-1, 3, 2))
            return set_uvs(mesh, atlas)

        unwrap.set_uvs = watched
        self.addCleanup(setattr, unwrap, "set_uvs", set_uvs)
        bpy.ops.vmlight.unwrap()
        cut = len(monkey.data.polygons) - faces
        self.assertTrue(0 < cut < faces / 5, cut)
        self.assertIn(f"1 mesh unwrapped; {cut} faces were cut into triangles", status.log[-1][1])
        # The triangles of the mesh have the atlas's own UVs, each corner where it was.
        corners, _, _ = mesh_export.triangles(monkey.data)
        uvs = numpy.array([loop.uv for loop in monkey.data.uv_layers["vmlight"].data], numpy.float32)[corners]

        def turned(triangles):
            """In an order that does not depend on which corner comes first."""
            return sorted(min((t[i:] + t[:i] for i in range(3))) for t in triangles.tolist())

        self.assertEqual(turned(uvs), turned(atlases[0]))
        # A second time, nothing is left to cut.
        bpy.ops.vmlight.unwrap()
        self.assertEqual(len(monkey.data.polygons), faces + cut)
        self.assertEqual(status.log[-1][1], "1 mesh unwrapped")

    def test_objects_that_share_a_mesh_are_unwrapped_once(self):
        first = plane()
        second = first.copy()
        self.scene.collection.objects.link(second)
        select(first, second)
        bpy.ops.vmlight.unwrap()
        from vmlight_addon import status
        self.assertEqual(status.log[-1][1], "1 mesh unwrapped")

    def test_modifiers_that_copy_uvs_are_warned_of(self):
        plane().modifiers.new("Twin", "MIRROR")
        bpy.ops.vmlight.unwrap()
        from vmlight_addon import status
        self.assertIn(("WARNING", '"floor": its modifier Twin lays copies onto the same UVs: apply it, then unwrap again'),
                      status.log)
