# SPDX-License-Identifier: Apache-2.0
"""UDIM tiles on the command line.

Run as cli_test.py is."""
import os
import sys
import unittest

from case import Case


class Tiles(Case):
    """UDIM: a floor in tile 1001, a wall in 1002, and a lid in 1011."""

    CORNERS = ((.125, .125), (.875, .125), (.875, .75), (.125, .75))
    SMALL = ["--resolution", "32", "--samples", "16"]

    def setUp(self):
        super().setUp()
        self.mesh("hero.obj", ((0, 0), (1, 0), (0, 1)))
        self.sky(1, 2, 3)

    def mesh(self, name, places):
        text = "v -1 -1 0\nv 1 -1 0\nv 1 1 0\nv -1 1 0\nv 1 -1 2\nv 1 1 2\nv -1 -1 2\nv -1 1 2\n"
        for u, v in places:
            text += "".join(f"vt {x + u} {y + v}\n" for x, y in self.CORNERS)
        text += "vn 0 0 1\nvn -1 0 0\nvn 0 0 -1\nf 1/1/1 2/2/1 3/3/1 4/4/1\nf 2/5/2 5/6/2 6/7/2 3/8/2\n"
        self.file(name, text + "f 7/9/3 8/10/3 6/11/3 5/12/3\n")

    def bake(self):
        self.done("makevismap", "hero.obj", "-o", "vm.<UDIM>.exr", *self.SMALL)

    def names(self, start):
        return sorted(name for name in os.listdir(self.folder) if name.startswith(start))

    def test_a_tile_is_the_map_of_the_mesh_with_its_uvs_moved_there(self):
        out = self.done("makevismap", "hero.obj", "-o", "vm.<UDIM>.exr", *self.SMALL)
        self.assertEqual(self.names("vm"), ["vm.1001.exr", "vm.1002.exr", "vm.1011.exr"])
        self.assertNotIn("WARNING", out, "triangles of other tiles are no surprise")
        for udim, (u, v) in ((1001, (0, 0)), (1002, (1, 0)), (1011, (0, 1))):
            self.assertIn(f"tile {udim}: bake: ", out)
            self.mesh("moved.obj", [(a - u, b - v) for a, b in ((0, 0), (1, 0), (0, 1))])
            said = self.done("makevismap", "moved.obj", "-o", "moved.exr", *self.SMALL)
            self.assertIn("reach out of [0,1] in uv", said, "here they are")
            self.assert_same_pixels(f"vm.{udim}.exr", "moved.exr", 0)
            self.done("makevismap", "hero.obj", "-o", "one.exr", "--udim", str(udim), *self.SMALL)
            self.assertEqual(self.read("one.exr"), self.read(f"vm.{udim}.exr"))
            self.assertIn(f'vmlight:udim: "{udim}"', self.oiiotool("--info", "-v", "one.exr"))

    def test_a_list_chooses_tiles(self):
        self.done("makevismap", "hero.obj", "-o", "vm.<UDIM>.exr", "--udims", "1011,1001-1002", *self.SMALL)
        self.assertEqual(self.names("vm"), ["vm.1001.exr", "vm.1002.exr", "vm.1011.exr"])
        out = self.done("makevismap", "hero.obj", "-o", "empty.<UDIM>.exr", "--udims=1033", *self.SMALL)
        self.assertIn("WARNING: tile 1033: no texel centre is covered: the map is empty", out)
        self.done("makevismap", "hero.obj", "-o", "one.<UDIM>.exr", "--udim=1002", *self.SMALL)
        self.assertEqual(self.names("one"), ["one.1002.exr"])

    def test_what_straddles_a_border_or_lies_in_no_tile_is_warned_about(self):
        self.mesh("odd.obj", ((0, 0), (1.5, 0), (-3, 0)))
        out = self.done("makevismap", "odd.obj", "-o", "vm.<UDIM>.exr", *self.SMALL)
        self.assertEqual(self.names("vm"), ["vm.1001.exr", "vm.1002.exr", "vm.1003.exr"])
        self.assertIn("WARNING: tile 1002: 2 of 6 triangles reach out of tile 1002 in uv", out)
        self.assertEqual(out.count("2 of 6 triangles reach out of all UDIM tiles"), 1, "for each tile again")

    def test_a_lightmap_of_each_tile(self):
        self.bake()
        os.remove(self.path("vm.1002.exr"))
        out = self.done("makelightmap", "vm.<UDIM>.exr", "sky.exr", "-o", "lit.<UDIM>.exr")
        self.assertEqual(self.names("lit"), ["lit.1001.exr", "lit.1011.exr"])
        self.assertEqual(out.count("filter: "), 1, "filtered for each tile")
        for udim in "1001", "1011":
            self.assertIn(f"tile {udim}: light: 1 map", out)
            self.done("makelightmap", f"vm.{udim}.exr", "sky.exr", "-o", "one.exr")
            self.assert_same_pixels(f"lit.{udim}.exr", "one.exr", 0)
            self.done("makelightmap", "vm.<UDIM>.exr", "sky.exr", "-o", "one.exr", "--udim", udim)
            self.assertEqual(self.read(f"lit.{udim}.exr"), self.read("one.exr"))
        self.done("makelightmap", "vm.<UDIM>.exr", "sky.exr", "-o", "f.<UDIM>.##.exr", "--frames", "1-2", "--rotate-y=0:90")
        self.assertEqual(self.names("f."), ["f.1001.01.exr", "f.1001.02.exr", "f.1011.01.exr", "f.1011.02.exr"])

    def test_albedo_or_environment_may_tell_the_tiles(self):
        self.bake()
        for udim in "1002", "1003":
            self.sky(.5, .5, .5, name=f"paint.{udim}.exr")
        self.done("makelightmap", "vm.1001.exr", "sky.exr", "--albedo", "paint.<UDIM>.exr", "-o", "lit.<UDIM>.exr")
        self.assertEqual(self.names("lit"), ["lit.1002.exr", "lit.1003.exr"])
        self.done("makecfem", "paint.<UDIM>.exr", "-o", "cfem.<UDIM>.exr", "--resolution=8")
        self.assertEqual(self.names("cfem"), ["cfem.1002.exr", "cfem.1003.exr"])

    def test_the_mesh_of_a_vismap_recipe_tells_the_tiles(self):
        self.bake()
        self.file("hero.vismap", 'mesh = "hero.obj"\nresolution = 32\nsamples = 16\n')
        self.file("hero.lightmap", 'vismap = "hero.vismap?udim=<UDIM>"\nenvironment = "sky.exr"\n')
        self.done("makelightmap", "hero.lightmap", "-o", "lit.<UDIM>.exr")
        self.done("makelightmap", "vm.<UDIM>.exr", "sky.exr", "-o", "stored.<UDIM>.exr")
        self.assertEqual(self.names("lit"), ["lit.1001.exr", "lit.1002.exr", "lit.1011.exr"])
        for udim in "1001", "1002", "1011":
            self.assert_same_pixels(f"lit.{udim}.exr", f"stored.{udim}.exr", 0)
        self.refused(2, 'vismap: "hero.vismap" is of one tile; did you mean "hero.vismap?udim=<UDIM>"?', "makelightmap",
                     "hero.vismap", "sky.exr", "-o", "x.<UDIM>.exr")

    def test_a_recipe_under_the_name_of_a_tile_is_of_that_tile(self):
        self.bake()
        self.file("hero.lightmap", 'vismap = "vm.<UDIM>.exr"\nenvironment = "sky.exr"\n')
        os.symlink("hero.lightmap", self.path("hero.1011.lightmap"))
        self.done("makelightmap", "hero.1011.lightmap", "-o", "a.exr")
        self.done("makelightmap", "hero.lightmap", "--udim=1011", "-o", "b.exr")
        self.done("makelightmap", "hero.lightmap?udim=1011", "-o", "c.<UDIM>.exr")
        self.assertEqual(self.names("c."), ["c.1011.exr"])
        self.assertEqual(self.read("a.exr"), self.read("b.exr"))
        self.assertEqual(self.read("a.exr"), self.read("c.1011.exr"))
        self.assertIn("udim = 1011\n", self.done("makelightmap", "hero.1011.lightmap", "--print-recipe"))
        self.refused(2, "a recipe holds no --udims", "makelightmap", "hero.lightmap", "--udims=1001", "--print-recipe")

    def test_meshes_in_files_by_tile(self):
        os.rename(self.path("hero.obj"), self.path("part.1002.obj"))
        self.done("makevismap", "part.<UDIM>.obj", "-o", "vm.<UDIM>.exr", *self.SMALL)
        self.assertEqual(self.names("vm"), ["vm.1002.exr"])

    def test_what_would_be_the_wrong_picture_is_refused(self):
        self.bake()
        vismap = ["makevismap", "hero.obj", *self.SMALL]
        light = ["makelightmap", "vm.<UDIM>.exr", "sky.exr"]
        one = ["makelightmap", "vm.1001.exr", "sky.exr"]
        self.refused(2, '"x.exr": 3 tiles need a name with <UDIM> for the number', *light, "-o", "x.exr", "--udims",
                     "1001-1003")
        self.refused(2, '"x.exr": 2 tiles need', *light, "-o", "x.exr", "--udims=1001,1002")
        for words in vismap, one:
            self.refused(2, "udims: neither -o nor the name of an input holds <UDIM>", *words, "-o", "x.exr",
                         "--udims=1001")
            self.refused(2, 'udims: "1001-" is not a list of UDIM tiles', *words, "-o", "x.<UDIM>.exr", "--udims=1001-")
            self.refused(2, "udims: 1000 is not a UDIM tile", *words, "-o", "x.<UDIM>.exr", "--udims=1000-1003")
            self.refused(2, "udim: 1000 is not in [1001, 9999]", *words, "-o", "x.exr", "--udim=1000")
            self.refused(2, "only one of udim and udims", *words, "-o", "x.<UDIM>.exr", "--udim=1001", "--udims=1001")
        self.refused(2, 'vismap: "vm.<UDIM>.exr": which tile?', *light, "-o", "x.exr")
        self.refused(2, 'environment: "sky.<UDIM>.exr": which tile?', "makecfem", "sky.<UDIM>.exr", "-o", "x.exr")
        self.refused(2, 'mesh: "hero.<UDIM>.obj": which tile?', "makevismap", "hero.<UDIM>.obj", "-o", "x.exr")
        self.refused(2, '"x.<UDIM>.exr": which tiles? No name of an input tells', *one, "-o", "x.<UDIM>.exr")
        self.refused(2, "all tiles would be the same picture", *one, "-o", "x.<UDIM>.exr", "--udims=1001,1002")
        for tool, words, key in (("makelightmap", ["gone.<UDIM>.exr", "sky.exr"], "vismap"),
                                 ("makecfem", ["gone.<UDIM>.exr"], "environment"),
                                 ("makevismap", ["gone.<UDIM>.exr"], "mesh")):
            self.refused(2, f'{key}: "gone.<UDIM>.exr": there is no such file for any tile', tool, *words, "-o",
                         "x.<UDIM>.exr")
        self.refused(2, '"hero.<UDIM>.lightmap": one recipe makes all tiles', "makelightmap", "hero.<UDIM>.lightmap",
                     "-o", "x.<UDIM>.exr")
        self.file("hero.vismap", 'mesh = "gone.<UDIM>.obj"\n')
        self.refused(1, 'mesh: "gone.<UDIM>.obj": there is no such file for any tile', "makelightmap",
                     "hero.vismap?udim=<UDIM>", "sky.exr", "-o", "x.<UDIM>.exr")
        self.refused(1, 'no folder "1001"', *light, "-o", "<UDIM>/x.exr")

    def test_a_tile_that_fails_is_named_and_those_before_it_stay(self):
        self.bake()
        self.file("vm.1002.exr", "no picture")
        result = self.run_tool("makelightmap", "vm.<UDIM>.exr", "sky.exr", "-o", "lit.<UDIM>.exr")
        self.assertEqual(result.returncode, 1)
        self.assertTrue(result.stderr.startswith('makelightmap ERROR: tile 1002: "vm.1002.exr": '), result.stderr)
        self.assertEqual(self.names("lit"), ["lit.1001.exr"])


if __name__ == "__main__":
    unittest.main(argv=[sys.argv[0], *sys.argv[1:]])
