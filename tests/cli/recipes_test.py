# SPDX-License-Identifier: Apache-2.0
"""Recipes on the command line.

Run as cli_test.py is."""
import os
import sys
import unittest

from case import CONFIG, QUAD, SKY, SOURCE, Case


class Recipes(Case):
    def bake(self):
        """The stages of a small light, by flags; and the flags of each."""
        self.file("quad.obj", QUAD)
        self.file("lid.obj", "v -9 -9 0.5\nv 1 -9 0.5\nv 1 9 0.5\nv -9 9 0.5\nf 1 2 3 4\n")
        self.vismap_words = ["quad.obj", "--occluder", "lid.obj", "--resolution", "16", "--samples", "16",
                             "--margin", "infinite"]
        self.cfem_words = [SKY, "--resolution", "32x16", "--colorconfig", CONFIG]
        self.light_words = ["vm.exr", "cfem.exr", "--rotate", "0,90,0.1", "--exposure", "-0.3"]
        self.done("makevismap", *self.vismap_words, "-o", "vm.exr")
        self.done("makecfem", *self.cfem_words, "-o", "cfem.exr")
        self.done("makelightmap", *self.light_words, "-o", "lit.exr")

    def test_a_recipe_makes_what_its_flags_make(self):
        self.bake()
        os.mkdir(self.path("recipes"))
        self.file("recipes/hero.vismap", 'mesh = "../quad.obj"\noccluder = ["../lid.obj"]\nresolution = 16\n'
                  'samples = 16\nmargin = "infinite"\n')
        self.file("recipes/studio.cfem", f'environment = "{SKY}"\nresolution = [32, 16]\ncolorconfig = "{CONFIG}"\n')
        self.file("recipes/hero.lightmap", 'vismap = "hero.vismap"\ncfem = "studio.cfem"\nrotate = [0, 90, 0.1]\n'
                  'exposure = -0.3\n')
        self.done("makevismap", "recipes/hero.vismap", "-o", "a.exr")
        self.done("makecfem", "recipes/studio.cfem", "-o", "b.exr")
        self.done("makelightmap", "recipes/hero.lightmap", "-o", "c.exr")
        self.assertEqual(self.read("a.exr"), self.read("vm.exr"))
        self.assertEqual(self.read("b.exr"), self.read("cfem.exr"))
        self.assertEqual(self.read("c.exr"), self.read("lit.exr"))
        # Recipes stand where images may, without a recipe around them too.
        self.done("makelightmap", "recipes/hero.vismap", "recipes/studio.cfem", *self.light_words[2:], "-o", "d.exr")
        self.assertEqual(self.read("d.exr"), self.read("lit.exr"))
        # A query alone says as much as a file.
        self.done("makelightmap", "x.lightmap?vismap=vm.exr&cfem=cfem.exr&rotate=0,90,0.1&exposure=-0.3", "-o", "e.exr")
        self.assertEqual(self.read("e.exr"), self.read("lit.exr"))

    def test_flags_override_the_query_which_overrides_the_file(self):
        self.bake()
        self.file("hero.lightmap", 'vismap = "vm.exr"\ncfem = "cfem.exr"\nrotate = [1, 2, 3]\nexposure = 5\n')
        self.done("makelightmap", "hero.lightmap?exposure=7&rotate=4,5,6", "-o", "a.exr", "--rotate", "0,90,0.1",
                  "--exposure=-0.3")
        self.assertEqual(self.read("a.exr"), self.read("lit.exr"))
        self.file("hero.vismap", 'mesh = "quad.obj"\noccluder = ["gone.obj"]\nresolution = 16\nsamples = 16\n'
                  'margin = "infinite"\n')
        self.done("makevismap", "--occluder", "lid.obj", "hero.vismap", "-o", "b.exr")
        self.assertEqual(self.read("b.exr"), self.read("vm.exr"))

    def test_a_printed_recipe_makes_the_same_image(self):
        self.bake()
        for tool, words, name, old in (("makevismap", self.vismap_words, "p.vismap", "vm.exr"),
                                       ("makecfem", self.cfem_words, "p.cfem", "cfem.exr"),
                                       ("makelightmap", self.light_words, "p.lightmap", "lit.exr")):
            before = self.contents()
            text = self.run_tool(tool, *words, "--print-recipe").stdout
            self.assertEqual(self.contents(), before)
            self.file(name, text)
            self.done(tool, name, "-o", "again.exr")
            self.assertEqual(self.read("again.exr"), self.read(old), text)
            self.assertEqual(self.run_tool(tool, name, "--print-recipe").stdout, text)
        self.assertEqual(text, 'vismap = "vm.exr"\ncfem = "cfem.exr"\nrotate = [0, 90, 0.1]\nexposure = -0.3\n')
        self.assertIn("environment = ", self.done("makelightmap", "vm.exr", SKY, "--print-recipe"))
        self.assertIn("cfem = ", self.done("makelightmap", "vm.exr", SKY, "--is-cfem", "--print-recipe"))
        self.refused(2, "a recipe holds neither --frames nor --rotate-y", "makelightmap", *self.light_words,
                     "--frames", "1-4", "--print-recipe")
        self.refused(2, "exposure: 99 is not in", "makelightmap", "vm.exr", SKY, "--exposure=99", "--print-recipe")
        self.refused(2, r'"caf\xe9.obj": a recipe is UTF-8, which this is not', "makevismap", b"caf\xe9.obj",
                     "--print-recipe")
        self.refused(1, r'"a\x0ab.obj": no such file', "makevismap", "a\nb.obj", "-o", "x.exr")

    def test_a_faulty_recipe_is_refused_with_its_line(self):
        self.file("bad.lightmap", 'vismap = "vm.exr"\nrotat = [0, 90, 0]\n')
        fault = '"bad.lightmap" line 2: unknown parameter "rotat"; did you mean "rotate"?'
        self.refused(1, fault, "makelightmap", "bad.lightmap", "-o", "x.exr")
        self.refused(1, "no such file", "makelightmap", "gone.lightmap", "-o", "x.exr")
        self.refused(2, '"more" is one argument too many', "makelightmap", "bad.lightmap", "more", "-o", "x.exr")
        self.file("noise.cfem", bytes(range(256)) * 16)
        self.file("empty.cfem")
        os.mkdir(self.path("folder.cfem"))
        for name in "noise.cfem", "empty.cfem", "folder.cfem":
            self.refused(1, f'"{name}"', "makecfem", name, "-o", "x.exr")
        self.refused(1, 'rotate: "abc" in "abc" is not a number', "makelightmap", "x.lightmap?rotate=abc", "-o", "x.exr")
        self.file("good.lightmap", "exposure = 1\n")
        self.refused(2, "exposure: 99 is not in", "makelightmap", "good.lightmap", "--exposure", "99", "-o", "x.exr")
        self.refused(2, "-o OUTPUT.exr is missing", "makelightmap", "good.lightmap")

    def test_a_missing_input_is_named_with_the_line_that_names_it(self):
        self.vismap()
        self.sky(1, 1, 1)
        self.file("a.lightmap", "exposure = 1\n")
        self.refused(1, '"a.lightmap": vismap is missing', "makelightmap", "a.lightmap", "-o", "x.exr")
        self.file("b.lightmap", 'vismap = "vm.exr"\n')
        self.refused(1, '"b.lightmap": environment is missing, or cfem', "makelightmap", "b.lightmap", "-o", "x.exr")
        self.file("c.lightmap", 'vismap = "vm.exr"\n\nenvironment = "gone.exr"\n')
        self.refused(1, '"c.lightmap" line 3: environment: "gone.exr": no such file', "makelightmap", "c.lightmap", "-o",
                     "x.exr")
        self.refused(1, 'ERROR: "other.exr": no such file', "makelightmap", "c.lightmap", "--environment", "other.exr",
                     "-o", "x.exr")
        self.file("d.lightmap", 'vismap = "vm.exr"\nenvironment = "sky.exr"\ncfem = "sky.exr"\n')
        self.refused(1, '"d.lightmap" line 3: cfem: environment is given too', "makelightmap", "d.lightmap", "-o",
                     "x.exr")
        self.done("makelightmap", "d.lightmap", "--environment=", "-o", "cleared.exr")
        self.file("e.vismap", 'mesh = "gone.obj"\n')
        self.file("e.lightmap", 'vismap = "e.vismap"\nenvironment = "sky.exr"\n')
        self.refused(1, '"e.lightmap" line 1: vismap: "e.vismap" line 1: mesh: "gone.obj": no such file',
                     "makelightmap", "e.lightmap", "-o", "x.exr")
        self.file("f.vismap", "samples = 1\n")
        self.refused(1, '"f.vismap": mesh is missing', "makevismap", "f.vismap", "-o", "x.exr")

    def test_an_input_of_the_wrong_stage_is_refused(self):
        self.bake()
        self.file("studio.cfem", 'environment = "sky.exr"\n')
        self.file("a.lightmap", 'vismap = "studio.cfem"\ncfem = "studio.cfem"\n')
        self.refused(1, '"a.lightmap" line 1: vismap: "studio.cfem": the recipe of a cfem, not of a vismap',
                     "makelightmap", "a.lightmap", "-o", "x.exr")
        self.file("b.lightmap", 'vismap = "vm.exr"\nenvironment = "studio.cfem"\n')
        self.refused(1, '"studio.cfem": the recipe of a cfem, not of an environment', "makelightmap", "b.lightmap", "-o",
                     "x.exr")
        self.file("c.lightmap", 'vismap = "vm.exr"\nenvironment = "cfem.exr"\n')
        self.refused(1, '"c.lightmap" line 2: environment: "cfem.exr": filtered already: give it as cfem',
                     "makelightmap", "c.lightmap", "-o", "x.exr")
        self.file("d.lightmap", 'vismap = "vm.exr"\ncfem = "lit.exr"\n')
        self.refused(1, '"lit.exr": neither an environment nor a CFEM', "makelightmap", "d.lightmap", "-o", "x.exr")

    def test_a_recipe_that_reads_itself_is_refused(self):
        self.bake()
        rest = 'vismap = "vm.exr"\ncfem = "cfem.exr"\n'
        self.file("self.lightmap", rest + 'albedo = "./self.lightmap"\n')
        self.refused(1, '"self.lightmap" line 3: albedo: "./self.lightmap" reads itself: "self.lightmap" -> '
                     '"./self.lightmap"', "makelightmap", "self.lightmap", "-o", "x.exr")
        self.file("a.lightmap", 'albedo = "b.lightmap"\n' + rest)
        self.file("b.lightmap", 'albedo = "a.lightmap"\n' + rest)
        self.refused(1, '"a.lightmap" reads itself: "a.lightmap" -> "b.lightmap" -> "a.lightmap"', "makelightmap",
                     "a.lightmap", "-o", "x.exr")
        self.file("self.cfem", 'environment = "self.cfem"\n')
        self.refused(1, '"self.cfem" reads itself', "makecfem", "self.cfem", "-o", "x.exr")
        # Not itself: the same file with another albedo.
        self.sky(0.5, 0.5, 0.5)
        self.file("twice.lightmap", rest + 'albedo = "twice.lightmap?albedo=sky.exr"\n')
        self.done("makelightmap", "twice.lightmap", "-o", "twice.exr")
        for link in range(70):
            self.file(f"{link}.lightmap", rest + f'albedo = "{link + 1}.lightmap"\n')
        self.refused(1, '"64.lightmap": more than 64 recipes, each within the last', "makelightmap", "0.lightmap", "-o",
                     "x.exr")

    def test_the_examples_work(self):
        examples = os.path.join(SOURCE, "configs/examples")
        self.done("makevismap", os.path.join(examples, "spot.vismap"), "-o", "vm.exr")
        self.done("makecfem", os.path.join(examples, "studio.cfem"), "-o", "cfem.exr")
        self.done("makelightmap", os.path.join(examples, "spot.lightmap"), "-o", "lit.exr")
        self.done("makelightmap", "vm.exr", "cfem.exr", "--rotate", "0,90,0", "--exposure", "-2.2", "-o", "expected.exr")
        self.assertEqual(self.read("lit.exr"), self.read("expected.exr"))


if __name__ == "__main__":
    unittest.main(argv=[sys.argv[0], *sys.argv[1:]])
