# SPDX-License-Identifier: Apache-2.0
"""The stages on the command line: meshes that are baked, and light on them.

Run as cli_test.py is."""
import os
import struct
import sys
import unittest

from case import CONFIG, QUAD, QUAD_WITHOUT_UV, SKY, SOURCE, SPOT, Case


class Meshes(Case):
    def test_what_is_not_a_mesh_is_refused_in_words(self):
        self.refused(1, '"missing.obj": no such file', "makevismap", "missing.obj", "-o", "x.exr")
        os.mkdir(self.path("folder.obj"))
        self.refused(1, '"folder.obj": not a file', "makevismap", "folder.obj", "-o", "x.exr")
        self.file("empty.obj")
        self.file("noise.obj", bytes(range(256)) * 64)
        self.file("noise.glb", b"glTF" + bytes(range(256)) * 64)
        self.file("noise.ply", b"ply\nformat ascii 1.0\nelement vertex 3\n" + bytes(range(256)))
        self.file("huge.ply", "ply\nformat ascii 1.0\nelement vertex 99999999999\nproperty float x\nend_header\n")
        self.file("text.txt", "hello")
        self.file("points.obj", "v 0 0 0\nv 1 0 0\nl 1 2\n")
        self.file("cut.glb", b"glTF\x02\0\0\0")
        for name in "empty.obj", "noise.obj", "noise.glb", "noise.ply", "huge.ply", "text.txt", "points.obj", "cut.glb":
            self.refused(1, f'"{name}": ', "makevismap", name, "-o", "x.exr")

    def test_a_mesh_without_uvs_says_so(self):
        self.file("bare.obj", QUAD_WITHOUT_UV)
        self.refused(1, '"bare.obj": no texture coordinates', "makevismap", "bare.obj", "-o", "x.exr")
        os.mkdir(self.path("meshes"))
        self.file("meshes/bare.obj", QUAD_WITHOUT_UV)
        self.refused(1, '"meshes/bare.obj": no texture coordinates', "makevismap", "meshes/bare.obj", "-o", "x.exr")
        self.file("quad.obj", QUAD)
        self.refused(1, "no texture coordinates", "makevismap", "quad.obj", "-o", "x.exr", "--uv-set", "1")

    def test_a_vertex_that_is_not_finite_is_named(self):
        self.file("nan.obj", QUAD.replace("v 1 1 0", "v nan 1 0"))
        self.refused(1, "is not finite", "makevismap", "nan.obj", "-o", "x.exr")

    def test_surprises_are_warned_about_with_their_counts(self):
        double = QUAD + "f 1/1/1 2/2/1 3/3/1\n"
        self.file("double.obj", double)
        out = self.done("makevismap", "double.obj", "-o", "x.exr", "--resolution", "8", "--samples", "4")
        self.assertRegex(out, r"WARNING: 36 texels \(56.25 % of those covered\) belong to more than one triangle")
        self.file("outside.obj", QUAD.replace("vt 1 1", "vt 2 2"))
        out = self.done("makevismap", "outside.obj", "-o", "x.exr", "--resolution", "8", "--samples", "4")
        self.assertIn("WARNING: 2 of 2 triangles reach out of [0,1]", out)
        # A map of one texel, and one triangle of two.
        self.file("one.obj", QUAD.replace("f 1/1/1 2/2/1 3/3/1 4/4/1", "vt 2 2\n" + 2 * "f 1/1/1 2/2/1 3/3/1\n" +
                                          "f 1/1/1 2/2/1 3/5/1"))
        out = self.done("makevismap", "one.obj", "-o", "x.exr", "--resolution", "1", "--samples", "4")
        self.assertIn("uv: 3 triangles cover", out)
        self.assertIn("; 1 texel overlaps;", out)
        self.assertIn("WARNING: 1 texel (100.00 % of those covered) belongs to more than one triangle: the first triangle "
                      "of the file has it", out)
        self.assertIn("WARNING: 1 of 3 triangles reaches out of [0,1]", out)

    def test_an_occluder_casts(self):
        self.file("quad.obj", QUAD)
        self.file("lid.obj", "v -9 -9 0.1\nv 9 -9 0.1\nv 9 9 0.1\nv -9 9 0.1\nf 1 2 3 4\n")
        self.done("makevismap", "quad.obj", "-o", "open.exr", "--resolution", "4", "--samples", "64")
        self.done("makevismap", "quad.obj", "--occluder", "lid.obj", "-o", "lid.exr", "--resolution", "4",
                  "--samples", "64")
        self.assertIn("Stats Min: 1.000000", self.oiiotool("open.exr", "--ch", "visibility", "--printstats"))
        self.assertIn("Stats Max: 0.0", self.oiiotool("lid.exr", "--ch", "visibility", "--printstats"))
        self.refused(1, '"gone.obj": no such file', "makevismap", "quad.obj", "--occluder", "gone.obj", "-o", "x.exr")


class Light(Case):
    def test_a_constant_sky_lights_by_visibility_alone(self):
        self.done("makevismap", SPOT, "-o", "vm.exr", "--resolution", "128", "--samples", "16")
        self.sky(0.25, 0.5, 2)
        self.done("makelightmap", "vm.exr", "sky.exr", "-o", "lit.exr", "--rotate", "10,20,30")
        self.oiiotool("vm.exr", "--ch", "visibility,visibility,visibility", "--chnames", "R,G,B", "--mulc",
                      "0.25,0.5,2", "-o", "expected.exr")
        self.assert_same_pixels("lit.exr", "expected.exr", 2e-6)

    def test_frames_equal_single_maps_at_their_angles(self):
        self.done("makevismap", SPOT, "-o", "vm.exr", "--resolution", "64", "--samples", "16")
        self.done("makecfem", SKY, "-o", "cfem.exr")
        self.done("makelightmap", "vm.exr", "cfem.exr", "-o", "lit.####.exr", "--frames", "9-12", "--rotate-y", "0:270")
        for frame, angle in ("0009", 0), ("0010", 90), ("0011", 180), ("0012", 270):
            self.done("makelightmap", "vm.exr", "cfem.exr", "-o", "one.exr", "--rotate", f"0,{angle},0")
            self.assert_same_pixels(f"lit.{frame}.exr", "one.exr", 1e-6)
        self.assertFalse(os.path.exists(self.path("lit.0013.exr")))

    def test_an_environment_is_filtered_as_makecfem_would(self):
        self.vismap()
        self.done("makecfem", SKY, "-o", "cfem.exr")
        self.done("makelightmap", "vm.exr", "cfem.exr", "-o", "a.exr")
        self.done("makelightmap", "vm.exr", SKY, "-o", "b.exr", "--model", "paper")
        self.assert_same_pixels("a.exr", "b.exr", 0)

    def test_ao_needs_normals(self):
        self.done("makevismap", SPOT, "-o", "vm.exr", "--resolution", "64", "--samples", "16")
        self.done("makecfem", SKY, "-o", "cfem.exr", "--resolution", "64")
        words = ["cfem.exr", "--model", "ao", "-o", "lit.exr"]
        self.refused(1, "the model ao needs what makevismap --channels normal bakes", "makelightmap", "vm.exr",
                     *words)
        self.assertFalse(os.path.exists(self.path("lit.exr")))
        self.done("makevismap", SPOT, "-o", "vmn.exr", "--resolution", "64", "--samples", "16", "--channels", "normal")
        self.done("makelightmap", "vmn.exr", *words)
        self.file("n.vismap", f'mesh = "{SPOT}"\nresolution = 64\nsamples = 16\nchannels = ["normal"]\n')
        self.done("makelightmap", "n.vismap", *words[:-1], "live.exr")
        self.assertEqual(self.read("live.exr"), self.read("lit.exr"))
        self.done("makelightmap", "vmn.exr", "cfem.exr", "-o", "a.exr")
        self.done("makelightmap", "vm.exr", "cfem.exr", "-o", "b.exr")
        self.assert_same_pixels("a.exr", "b.exr", 0)

    def test_a_basis_lights_by_the_model_of_its_name(self):
        self.done("makecfem", SKY, "--stack", "-o", "stack.exr")
        for basis, channels, floats in (("sh", "sh.24", 25), ("mask", "mask.10", 18), ("cells", "cells.11", 19)):
            words = os.path.join(SOURCE, "tests/data/gazebo.obj"), "--resolution", "64", "--samples", "32", "--basis", basis
            self.done("makevismap", *words, "-o", basis + ".exr")
            info = self.oiiotool("--info", "-v", basis + ".exr")
            self.assertIn(channels, info)
            self.assertIn(f"{floats} channel", info)
            told = self.done("makelightmap", basis + ".exr", "stack.exr", "--rotate", "0,30,0", "-o", "a.exr")
            self.assertIn(f"model: {basis}, the best that the visibility map is fit for", told)
            told = self.done("makelightmap", basis + ".exr", SKY, "--rotate", "0,30,0", "-o", "b.exr")
            self.assertIn("reduce: 512x256 to 128x64", told)  # no lobe is filtered that is not looked up
            self.assertNotIn("filter:", told)
            self.assertEqual(self.read("a.exr"), self.read("b.exr"))
            # Live, from recipes: the same bytes.
            self.file(basis + ".vismap", self.done("makevismap", *words, "--print-recipe").encode())
            self.file("x.lightmap", self.done("makelightmap", basis + ".vismap", SKY, "--rotate", "0,30,0",
                                              "--print-recipe").encode())
            self.done("makelightmap", "x.lightmap", "-o", "c.exr")
            self.assertEqual(self.read("a.exr"), self.read("c.exr"))
            if basis == "sh":
                self.done("makevismap", *words, "--order", "3", "--format", "half", "-o", "half.exr")
                self.done("makelightmap", "half.exr", "stack.exr", "-o", "x.exr")
            else:
                self.refused(2, f"--format half: the basis {basis} holds whole numbers that half floats do not keep",
                             "makevismap", *words, "--format", "half", "-o", "half.exr")
            self.oiiotool(basis + ".exr", "--resize", "32x32", "-o", "small.exr")
            if basis != "sh":
                self.refused(1, "whole numbers below 2^24 any more", "makelightmap", "small.exr", "stack.exr", "-o",
                             "x.exr")
            info = self.oiiotool("--info", "-v", "b.exr")  # and no word of a filter that was not used
            self.assertIn("vmlight:cfem_resolution", info)
            self.assertNotIn("vmlight:cfem_filter", info)
            for flag, value in ("--cfem-filter", "sh"), ("--cfem-order", "4"):
                self.refused(2, f"the model {basis} reads the environment unfiltered", "makelightmap", basis + ".exr",
                             SKY, "--model", basis, flag, value, "-o", "x2.exr")
        self.refused(2, "only the basis sh has bands", "makevismap", SPOT, "--order", "4", "-o", "x.exr")
        self.refused(1, "basis: mask goes with the measure cosine, not with uniform", "makevismap", SPOT, "--basis",
                     "mask", "--measure", "uniform", "-o", "x.exr")

    def test_a_stack_lights_by_lobes(self):
        self.vismap()
        self.done("makecfem", SKY, "-o", "cfem.exr")
        self.assertIn("to 10 of 128x64", self.done("makecfem", SKY, "--stack", "-o", "stack.exr"))
        self.assertIn("model: lobe, the best that the visibility map is fit for", self.done("makelightmap", "vm.exr", "stack.exr", "-o",
                                                                          "stack_lit.exr"))
        self.assertIn("model: lobe, the best that the visibility map is fit for",
                      self.done("makelightmap", "vm.exr", SKY, "-o", "env_lit.exr"))
        self.assertIn("model: paper, since the CFEM is no stack", self.done("makelightmap", "vm.exr", "cfem.exr", "-o",
                                                                            "paper_lit.exr"))
        self.assert_same_pixels("stack_lit.exr", "env_lit.exr", 0)
        # What knows no stacks reads the first image, a CFEM.
        self.assert_same_pixels("stack.exr", "cfem.exr", 0)
        self.done("makelightmap", "vm.exr", "stack.exr", "--model", "paper", "-o", "x.exr")
        self.assert_same_pixels("x.exr", "paper_lit.exr", 0)
        self.done("makecfem", SKY, "--stack", "-o", "again.exr", "--threads", "1")
        self.assertEqual(self.read("again.exr"), self.read("stack.exr"))
        self.oiiotool("stack.exr", "--subimage", "0", "-o", "first.exr")
        self.assertIn("model: paper", self.done("makelightmap", "vm.exr", "first.exr", "-o", "x.exr"))
        self.refused(1, '"cfem.exr": model lobe needs a stack of lobes', "makelightmap", "vm.exr", "cfem.exr", "--model",
                     "lobe", "-o", "none.exr")
        self.assertFalse(os.path.exists(self.path("none.exr")))
        self.done("makecfem", SKY, "--stack", "-o", "half.exr", "--format", "half")
        self.done("makelightmap", "vm.exr", "half.exr", "-o", "x.exr")
        self.assert_same_pixels("x.exr", "stack_lit.exr", 0.02)

    def test_the_same_light_in_two_colour_spaces_gives_the_same_map(self):
        self.vismap()
        self.oiiotool("--colorconfig", CONFIG, SKY, "--colorconvert", "lin_rec709_scene", "ACEScg", "-d", "float", "-o",
                      "sky_acescg.exr")
        config = ["--colorconfig", CONFIG]
        self.done("makelightmap", "vm.exr", SKY, *config, "-o", "a.exr", "--colorspace", "lin_rec709_scene")
        self.done("makelightmap", "vm.exr", "sky_acescg.exr", *config, "-o", "b.exr", "--colorspace", "ACEScg")
        self.assert_same_pixels("a.exr", "b.exr", 1e-4)
        self.refused(1, "Nonsense", "makelightmap", "vm.exr", SKY, *config, "-o", "x.exr", "--colorspace", "Nonsense")
        self.refused(1, "none is set (--colorconfig or $OCIO)", "makecfem", SKY, "--colorspace", "ACEScg", "-o", "x.exr")
        self.refused(1, "missing.ocio", "makecfem", SKY, "--colorconfig", "missing.ocio", "-o", "x.exr")

    def test_albedo_multiplies_in_linear_light(self):
        self.vismap()
        self.sky(1, 1, 1)
        self.oiiotool("--pattern", "constant:color=0.5,0.5,0.5", "8x8", "3", "-d", "uint8", "-o", "gray.png")
        self.done("makelightmap", "vm.exr", "sky.exr", "--albedo", "gray.png", "-o", "lit.exr")
        stats = self.oiiotool("lit.exr", "--printstats")
        self.assertIn("Stats Avg: 0.2158", stats.replace("0.215861", "0.2158"))  # sRGB 128 is 0.2159 in linear light
        self.refused(1, "no such file", "makelightmap", "vm.exr", "sky.exr", "--albedo", "gone.png", "-o", "x.exr")

    def test_what_is_not_light_or_visibility_is_refused(self):
        self.vismap()
        self.done("makecfem", SKY, "-o", "cfem.exr")
        self.done("makelightmap", "vm.exr", "cfem.exr", "-o", "lit.exr")
        self.file("noise.exr", bytes(range(256)) * 16)
        self.file("noise.hdr", "#?RADIANCE\n\n-Y 4 +X 4\n")
        self.file("empty.exr")
        with open(self.path("cfem.exr"), "rb") as whole:
            self.file("cut.exr", whole.read()[:5000])
        self.refused(1, "not a visibility map", "makelightmap", "cfem.exr", "cfem.exr", "-o", "x.exr")
        self.refused(1, "not a visibility map", "makelightmap", "lit.exr", "cfem.exr", "-o", "x.exr")
        self.refused(1, "neither an environment nor a CFEM", "makelightmap", "vm.exr", "vm.exr", "-o", "x.exr")
        self.refused(1, "neither an environment nor a CFEM", "makelightmap", "vm.exr", "lit.exr", "-o", "x.exr")
        self.refused(1, "visibility map", "makecfem", "vm.exr", "-o", "x.exr")
        for name in "noise.exr", "noise.hdr", "empty.exr", "cut.exr":
            self.refused(1, f'"{name}": ', "makecfem", name, "-o", "x.exr")
            self.refused(1, f'"{name}": ', "makelightmap", "vm.exr", name, "-o", "x.exr")
            self.refused(1, f'"{name}": ', "makelightmap", name, "cfem.exr", "-o", "x.exr")

    def test_bad_pixels_are_refused_unless_mending_is_asked_for(self):
        rows = b""
        for y in range(4):
            pixels = [(1.0, 1.0, 1.0)] * 8
            if y == 2:
                pixels[5] = (float("nan"), float("inf"), -1.0)
            rows += b"".join(struct.pack("<3f", *p) for p in reversed(pixels))
        # Little-endian PFM, bottom row first; OIIO 3.1 takes it for the top one.
        flipped = b"".join(rows[i:i + 96] for i in range(0, len(rows), 96))
        self.file("bad.pfm", b"PF\n8 4\n-1.0\n" + flipped)
        self.refused(1, "environment has 3 values that are NaN, infinite or negative, the first at pixel (2, ",
                     "makecfem", "bad.pfm", "-o", "x.exr")
        out = self.done("makecfem", "bad.pfm", "-o", "x.exr", "--sanitize")
        self.assertIn("3 bad values of the environment were mended", out)
        self.assertNotIn("nan", self.oiiotool("x.exr", "--printstats").lower().replace("nancount: 0", ""))


if __name__ == "__main__":
    unittest.main(argv=[sys.argv[0], *sys.argv[1:]])
