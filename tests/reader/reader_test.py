# SPDX-License-Identifier: Apache-2.0
"""The readers in a host that knows nothing of them: oiiotool, with the plugins on OIIO_LIBRARY_PATH.

Run as: reader_test.py [CASE ...], with VMLIGHT_BIN (the executables' folder), VMLIGHT_SOURCE (the repository),
OIIO_LIBRARY_PATH (the plugins' folder) and oiiotool on the path; VMLIGHT_PRELOAD may name what a host must load first.
Each TestCase is one CTest test.
"""
import os
import random
import shutil
import subprocess
import sys
import tempfile
import unittest

BIN = os.environ["VMLIGHT_BIN"]
SOURCE = os.environ["VMLIGHT_SOURCE"]
PLUGINS = os.environ["OIIO_LIBRARY_PATH"]


class Case(unittest.TestCase):
    def setUp(self):
        self.folder = tempfile.mkdtemp(prefix="vmlight ü ")
        self.environment = {k: v for k, v in os.environ.items() if k != "OCIO"}
        for name in ("spot.obj", "studio_small_03.hdr"):
            shutil.copy(os.path.join(SOURCE, "tests/data", name), self.folder)
        self.file("hero.vismap", 'mesh = "spot.obj"\nresolution = [200, 150]\nsamples = 8\n')
        self.file("studio.cfem", 'environment = "studio_small_03.hdr"\nresolution = 64\n')
        self.file("hero.lightmap", 'vismap = "hero.vismap"\ncfem = "studio.cfem"\nrotate = [0, 30, 0]\n')

    def tearDown(self):
        shutil.rmtree(self.folder)

    def path(self, name):
        return os.path.join(self.folder, name)

    def file(self, name, content):
        with open(self.path(name), "wb") as out:
            out.write(content.encode() if isinstance(content, str) else content)
        return name

    def run_tool(self, tool, *words):
        environment = dict(self.environment)
        if tool == "oiiotool":
            environment["LD_PRELOAD"] = os.environ.get("VMLIGHT_PRELOAD", "")
            # Not for leaks, which the unit tests look for: GCC 12's search for them dies in what threads leave behind.
            environment["ASAN_OPTIONS"] = os.environ.get("ASAN_OPTIONS", "") + ":detect_leaks=0"
        return subprocess.run([tool, *words], capture_output=True, text=True, errors="replace", cwd=self.folder,
                              env=environment, timeout=300)

    def done(self, tool, *words):
        result = self.run_tool(tool, *words)
        self.assertEqual(result.returncode, 0, result.stdout + result.stderr)
        return result.stdout + result.stderr

    def refused(self, text, *words):
        """The host ends by its own will (a signal would be a negative code), and its message names the fault."""
        result = self.run_tool("oiiotool", *words)
        self.assertGreater(result.returncode, 0, (words, result.stdout, result.stderr))
        self.assertLess(result.returncode, 128, (words, result.stdout, result.stderr))
        self.assertIn(text, result.stdout + result.stderr)

    def make(self, tool, *words):
        self.done(os.path.join(BIN, tool), *words, "--quiet")

    def assert_same_pixels(self, a, b):
        self.done("oiiotool", a, b, "--fail", "0", "--diff")


class Pixels(Case):
    def test_a_recipe_and_the_executable_give_the_same_bits(self):
        self.make("makevismap", "spot.obj", "-o", "vm.exr", "--resolution", "200x150", "--samples", "8")
        self.make("makecfem", "studio_small_03.hdr", "-o", "cfem.exr", "--resolution", "64")
        self.make("makelightmap", "vm.exr", "cfem.exr", "-o", "lit.exr", "--rotate", "0,30,0")
        self.assert_same_pixels("hero.vismap", "vm.exr")
        self.assert_same_pixels("studio.cfem", "cfem.exr")
        self.assert_same_pixels("hero.lightmap", "lit.exr")
        # Converted by the host, and from stored inputs.
        self.done("oiiotool", "hero.lightmap", "-o", "converted.exr")
        self.assert_same_pixels("converted.exr", "lit.exr")
        self.file("stored.lightmap", 'vismap = "vm.exr"\ncfem = "cfem.exr"\nrotate = [0, 30, 0]\n')
        self.assert_same_pixels("stored.lightmap", "lit.exr")
        self.file("env.lightmap", 'vismap = "vm.exr"\nenvironment = "studio_small_03.hdr"\ncfem_resolution = 64\n')
        self.assert_same_pixels("env.lightmap?rotate=0,30,0&model=paper", "lit.exr")

    def test_a_stack_is_subimages_and_lights_by_lobes(self):
        self.make("makevismap", "hero.vismap", "-o", "vm.exr")
        self.make("makecfem", "studio_small_03.hdr", "-o", "stack.exr", "--resolution", "64", "--stack")
        self.make("makelightmap", "vm.exr", "stack.exr", "-o", "lobe.exr", "--rotate", "0,30,0", "--model", "lobe")
        info = self.done("oiiotool", "--info", "-v", "-a", "studio.cfem?stack=true")
        self.assertIn("10 subimages", info)
        self.assertIn("vmlight:lobe: 0.5", info)
        self.done("oiiotool", "studio.cfem?stack=true", "-o", "converted.exr")
        self.done("oiiotool", "-a", "converted.exr", "stack.exr", "--fail", "0", "--diff")
        self.assert_same_pixels("studio.cfem", "stack.exr")  # the first level is the CFEM
        self.file("stack.cfem", 'environment = "studio_small_03.hdr"\nresolution = 64\nstack = true\n')
        self.file("env.lightmap", 'vismap = "vm.exr"\nenvironment = "studio_small_03.hdr"\ncfem_resolution = 64\n')
        self.file("a.lightmap", 'vismap = "hero.vismap"\ncfem = "stack.cfem"\n')
        self.file("b.lightmap", 'vismap = "vm.exr"\ncfem = "stack.exr"\nmodel = "auto"\n')
        for name in "env", "a", "b":
            self.assert_same_pixels(f"{name}.lightmap?rotate=0,30,0", "lobe.exr")
        self.make("makevismap", "hero.vismap?channels=normal", "-o", "vmn.exr")
        self.assert_same_pixels("hero.vismap?channels=normal", "vmn.exr")
        noisy = "hero.vismap?target_error=0.05&channels=error,normal"
        self.make("makevismap", noisy, "-o", "noisy.exr")
        # An EXR has its channels in another order.
        names = "visibility,direction.x,direction.y,direction.z,normal.x,normal.y,normal.z,error"
        self.done("oiiotool", noisy, "--ch", names, "noisy.exr", "--ch", names, "--fail", "0", "--diff")
        self.assertNotIn("vmlight:samples", self.done("oiiotool", "--info", "-v", noisy))  # nothing is baked yet
        self.assertIn("vmlight:samples", self.done("oiiotool", "--info", "-v", "noisy.exr"))
        self.refused("target_error: 1e-09 is out of reach", "hero.vismap?target_error=1e-9", "-o", "x.exr")
        self.file("ao.lightmap", 'vismap = "vmn.exr"\ncfem = "stack.cfem"\nmodel = "ao"\n')
        self.make("makelightmap", "vmn.exr", "stack.exr", "-o", "ao.exr", "--model", "ao")
        self.assert_same_pixels("ao.lightmap", "ao.exr")
        self.file("plain.lightmap", 'vismap = "hero.vismap"\ncfem = "stack.cfem"\nmodel = "ao"\n')
        self.refused("makevismap --channels normal", "plain.lightmap", "-o", "x.exr")
        self.assertIn('vmlight:model: "lobe"', self.done("oiiotool", "--info", "-v", "a.lightmap"))
        self.assertIn('vmlight:model: "paper"', self.done("oiiotool", "--info", "-v", "hero.lightmap"))
        self.refused("makecfem --stack", "hero.lightmap?model=lobe", "-o", "x.exr")

    def test_an_executable_reads_recipes_where_it_reads_images(self):
        self.make("makelightmap", "hero.vismap", "studio.cfem", "-o", "lit.exr", "--rotate", "0,30,0")
        self.assert_same_pixels("hero.lightmap", "lit.exr")


class Tiles(Case):
    """UDIM: a quad in tile 1001 and one in 1012, at an angle."""

    def setUp(self):
        super().setUp()
        corners = ((.125, .125), (.875, .125), (.875, .75), (.125, .75))
        self.file("corner.obj", "v -1 -1 0\nv 1 -1 0\nv 1 1 0\nv -1 1 0\nv 1 -1 2\nv 1 1 2\nvn 0 0 1\nvn -1 0 0\n"
                  + "".join(f"vt {x + tile} {y + tile}\n" for tile in (0, 1) for x, y in corners)
                  + "f 1/1/1 2/2/1 3/3/1 4/4/1\nf 2/5/2 5/6/2 6/7/2 3/8/2\n")
        self.file("corner.vismap", 'mesh = "corner.obj"\nresolution = 100\nsamples = 8\n')
        self.file("corner.lightmap", 'vismap = "vm.<UDIM>.exr"\ncfem = "studio.cfem"\n')
        self.make("makevismap", "corner.obj", "-o", "vm.<UDIM>.exr", "--resolution", "100", "--samples", "8")
        self.make("makelightmap", "vm.<UDIM>.exr", "studio.cfem", "-o", "lit.<UDIM>.exr")

    def test_a_tile_has_the_bits_of_the_executable(self):
        for udim in "1001", "1012":
            self.assert_same_pixels(f"corner.vismap?udim={udim}", f"vm.{udim}.exr")
            self.assert_same_pixels(f"corner.lightmap?udim={udim}", f"lit.{udim}.exr")
            self.assert_same_pixels(f"corner.lightmap?udim={udim}&vismap=corner.vismap?udim=<UDIM>", f"lit.{udim}.exr")
            os.symlink("corner.lightmap", self.path(f"link.{udim}.lightmap"))
            self.assert_same_pixels(f"link.{udim}.lightmap", f"lit.{udim}.exr")
        self.done("oiiotool", "link.#.lightmap", "--frames", "1001,1012", "-o", "out.#.exr")
        self.assert_same_pixels("out.1012.exr", "lit.1012.exr")

    def test_a_bad_tile_is_refused(self):
        self.refused("corner.lightmap?udim=1000", "corner.lightmap?udim=1000", "-o", "x.exr")
        self.file("bad.lightmap", 'vismap = "vm.<UDIM>.exr"\ncfem = "studio.cfem"\nudim = 1002\n')
        self.refused("vm.1002.exr", "bad.lightmap", "-o", "x.exr")


class Info(Case):
    def test_describing_computes_nothing(self):
        # What takes the mesh or the environment's pixels to know cannot be known here.
        self.file("broken.obj", "this is no mesh\n")
        self.done("oiiotool", "--pattern", "constant:color=1,1,1", "64x32", "3", "-d", "float", "--compression", "none",
                  "-o", "whole.exr")
        with open(self.path("whole.exr"), "rb") as data:
            self.file("cut.exr", data.read()[:-3000])
        self.file("x.vismap", 'mesh = "broken.obj"\nresolution = 8192\nsamples = 100000\n')
        self.file("x.cfem", 'environment = "cut.exr"\n')
        self.file("x.lightmap", 'vismap = "x.vismap"\ncfem = "x.cfem"\nexposure = 1.5\n')
        info = self.done("oiiotool", "--info", "-v", "x.vismap", "x.cfem", "x.lightmap")
        for text in ("8192 x 8192, 4 channel, float vismap", "128 x   64, 3 channel, float cfem",
                     "8192 x 8192, 3 channel, float lightmap", "tile size: 64 x 64",
                     "channel list: visibility, direction.x, direction.y, direction.z", 'colorInteropID: "data"',
                     'colorInteropID: "lin_rec709_scene"', 'vmlight:stage: "vismap"', 'vmlight:stage: "cfem"',
                     'vmlight:stage: "lightmap"', 'vmlight:mesh: "broken.obj"', 'vmlight:samples: "100000"',
                     'vmlight:exposure: "1.5"'):
            self.assertIn(text, info)
        self.assertNotIn(self.folder, info.replace("Reading ", ""), "a path in the metadata")
        self.refused("broken.obj", "x.vismap?resolution=64", "-o", "y.exr")
        self.refused("cut.exr", "x.cfem", "-o", "y.exr")

    def test_a_recipe_and_the_executable_say_the_same(self):
        self.make("makevismap", "hero.vismap", "-o", "vm.exr")
        self.make("makecfem", "studio.cfem", "-o", "cfem.exr")
        self.make("makelightmap", "hero.lightmap", "-o", "lit.exr")
        self.file("env.lightmap", 'vismap = "hero.vismap"\nenvironment = "./studio_small_03.hdr"\ncfem_filter = "sh"\n'
                  'cfem_order = 4\n')
        self.make("makelightmap", "env.lightmap", "-o", "env.exr")
        for recipe, image in (("hero.vismap", "vm.exr"), ("studio.cfem", "cfem.exr"), ("hero.lightmap", "lit.exr"),
                              ("env.lightmap", "env.exr")):
            # But for what takes the mesh's vertices to know; and a file keeps no empty texts.
            told = [sorted(line for line in self.done("oiiotool", "--info", "-v", name).splitlines()
                           if line.strip().startswith(("vmlight:", "colorInteropID", "chromaticities"))
                           and "vmlight:meshHash" not in line and not line.endswith(': ""'))
                    for name in (recipe, image)]
            self.assertGreater(len(told[0]), 6)
            self.assertEqual(*told)
        for line in ('vmlight:environment: "studio_small_03.hdr"', 'vmlight:cfem_filter: "sh"', 'vmlight:cfem_order: "4"',
                     'vmlight:cfem_resolution: "128x64"', 'vmlight:cfem_sanitize: "false"'):
            self.assertIn("    " + line, told[1])
        # The same, however the environment came to be filtered.
        self.make("makelightmap", "vm.exr", "cfem.exr", "--rotate", "0,30,0", "-o", "apart.exr")
        self.make("makelightmap", "vm.exr", "studio_small_03.hdr", "--cfem-resolution", "64", "--rotate", "0,30,0",
                  "--model", "paper", "-o", "whole.exr")
        self.make("makecfem", "studio.cfem", "--stack", "-o", "stack.exr")
        self.make("makelightmap", "vm.exr", "stack.exr", "--rotate", "0,30,0", "--model", "paper", "-o", "level.exr")
        for name in "apart.exr", "whole.exr", "level.exr":
            with open(self.path(name), "rb") as image, open(self.path("lit.exr"), "rb") as expected:
                self.assertEqual(image.read(), expected.read(), name)


class Faults(Case):
    def test_foreign_files_are_left_to_their_readers(self):
        self.file("broken.png", b"\x89PNG\r\n\x1a\n and no more")
        self.file("empty.png", b"")
        for name in ("broken.png", "empty.png"):
            self.refused(name, "--info", name)

    def test_a_broken_recipe_is_named(self):
        self.file("empty.lightmap", b"")
        self.file("noise.lightmap", random.Random(1).randbytes(4000))
        self.file("word.lightmap", "rotation = [0, 90, 0]\n")
        os.mkdir(self.path("folder.lightmap"))
        for name, text in (("empty.lightmap", "empty.lightmap"), ("noise.lightmap", "noise.lightmap"),
                           ("folder.lightmap", "folder.lightmap"), ("word.lightmap", 'unknown parameter "rotation"'),
                           ("hero.lightmap?rotate=abc", "hero.lightmap?rotate=abc")):
            self.refused(text, name, "-o", "x.exr")
            self.assertFalse(os.path.exists(self.path("x.exr")))

    def test_a_recipe_that_reads_itself_is_named(self):
        rest = 'vismap = "hero.vismap"\ncfem = "studio.cfem"\n'
        self.file("a.lightmap", rest + 'albedo = "b.lightmap"\n')
        self.file("b.lightmap", rest + 'albedo = "a.lightmap"\n')
        self.refused('a.lightmap" reads itself', "a.lightmap", "-o", "x.exr")
        self.file("self.cfem", 'environment = "./self.cfem"\n')
        self.refused('self.cfem" reads itself', "self.cfem", "-o", "x.exr")

    def test_a_missing_input_is_named(self):
        os.remove(self.path("spot.obj"))
        self.refused('hero.lightmap" line 1: vismap: "hero.vismap" line 1: mesh: "spot.obj": no such file', "hero.lightmap",
                     "-o", "x.exr")


class Symbols(unittest.TestCase):
    @staticmethod
    def shown(library):
        lines = subprocess.run(["nm", "-D", "--defined-only", os.path.join(PLUGINS, library)], check=True,
                               capture_output=True, text=True).stdout.splitlines()
        return sorted(line.split()[-1] for line in lines)

    def test_a_plugin_shows_its_own_symbols_only(self):
        for stage in ("vismap", "cfem", "lightmap"):
            self.assertEqual(self.shown(stage + ".imageio.so"),
                             sorted(stage + name for name in ("_imageio_version", "_imageio_library_version",
                                                              "_input_imageio_create", "_input_extensions")))

    def test_what_they_share_is_in_a_process_once(self):
        self.assertEqual(self.shown("libvmlight_readers.so.0.1"), ["vmlight_create_reader"])
        for stage in ("vismap", "cfem", "lightmap"):
            needed = subprocess.run(["readelf", "-d", os.path.join(PLUGINS, stage + ".imageio.so")], check=True,
                                    capture_output=True, text=True).stdout
            self.assertIn("libvmlight_readers.so.0.1", needed)


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1] + sys.argv[1:], verbosity=2)
