# SPDX-License-Identifier: Apache-2.0
"""A bake for an error, or for a time, on the command line.

Run as cli_test.py is."""
import re
import sys
import unittest

from case import QUAD, SPOT, Case


class Errors(Case):
    BAKE = ["makevismap", SPOT, "--resolution", "64"]

    def attribute(self, image, name):
        found = re.search(f"vmlight:{name}: (.*)", self.oiiotool("--info", "-v", image))
        return found and found[1].strip('"')

    def told(self, out):
        """The error, the texels and the rays of the line that tells them."""
        line = r"error: (\S+) \(RMS of V, from (\d+) texels baked twice\) at (\d+) rays a texel; "
        self.assertRegex(out, line)
        error, texels, rays = re.search(line, out).groups()
        return float(error), int(texels), int(rays)

    def test_an_error_that_is_asked_for_is_told_and_kept_in_the_file(self):
        error, texels, rays = self.told(self.done(*self.BAKE, "--target-error", "0.02", "-o", "a.exr"))
        self.assertLessEqual(error, 0.02)
        self.assertGreater(texels, 1000)
        self.assertEqual(self.attribute("a.exr", "samples"), str(rays))
        self.assertEqual(self.attribute("a.exr", "target_error"), "0.02")
        self.assertAlmostEqual(float(self.attribute("a.exr", "error")), error, delta=0.001)
        self.done(*self.BAKE, "--target-error", "0.02", "-o", "b.exr", "--threads", "1")
        self.assertEqual(self.read("a.exr"), self.read("b.exr"))
        out = self.done(*self.BAKE, "--samples", str(rays), "-o", "c.exr")
        self.assertNotIn("error:", out)
        self.assertIsNone(self.attribute("c.exr", "error"))
        self.assert_same_pixels("a.exr", "c.exr", 0)

    def test_the_channel_is_there_with_its_estimate(self):
        out = self.done(*self.BAKE, "--channels", "error", "--samples", "32", "-o", "a.exr")
        self.assertEqual(self.told(out)[2], 32)
        self.assertIn("error", self.oiiotool("--info", "-v", "a.exr"))
        self.assertIsNotNone(self.attribute("a.exr", "error"))
        self.refused(1, "samples: 1 is too few for the channel error, which takes 2", *self.BAKE, "-o", "x.exr",
                     "--channels", "error", "--samples", "1")

    def test_where_nothing_is_occluded_one_ray_is_enough(self):
        self.vismap()
        out = self.done("makevismap", "quad.obj", "-o", "a.exr", "--resolution", "32", "--target-error", "1e-3")
        self.assertIn("error: 0 (1024 texels baked twice are the same both times) at 1 ray a texel", out)
        self.assertEqual(self.attribute("a.exr", "error"), "0")

    def test_one_texel_that_agrees_with_itself_takes_64_rays(self):
        self.file("quad.obj", QUAD)
        self.assertIn("error: 0 (1 texel baked twice is the same both times) at 64 rays a texel; ",
                      self.done("makevismap", "quad.obj", "-o", "a.exr", "--resolution", "1", "--target-error", "1e-3"))
        self.assertEqual(self.attribute("a.exr", "samples"), "64")

    def test_an_error_out_of_reach_is_refused(self):
        self.refused(1, "target_error: 1e-09 is out of reach: 1048576 rays a texel come to ", *self.BAKE[:-1], "16", "-o",
                     "x.exr", "--target-error", "1e-9")

    def test_a_time_gives_the_rays_and_the_file_says_them(self):
        _, _, rays = self.told(self.done(*self.BAKE, "--time-budget", "0.05", "-o", "a.exr"))
        self.assertEqual(self.attribute("a.exr", "samples"), str(rays))
        self.assertEqual(self.attribute("a.exr", "target_error"), "none")
        self.assertIsNotNone(self.attribute("a.exr", "error"))
        self.assertIsNone(self.attribute("a.exr", "time_budget"))
        self.done(*self.BAKE, "--samples", str(rays), "-o", "b.exr")
        self.assert_same_pixels("a.exr", "b.exr", 0)

    def test_a_time_too_short_for_one_ray_takes_one_with_a_warning(self):
        out = self.done("makevismap", SPOT, "--resolution", "2048", "--margin", "0", "--time-budget", "0.001", "-o",
                        "a.exr")
        self.assertRegex(out, "WARNING: time_budget: 1 ray a texel, the least there is, takes about .* s, not 0.001\n")
        self.assertEqual(self.attribute("a.exr", "samples"), "1")

    def test_a_time_is_no_part_of_a_recipe(self):
        self.refused(2, "a recipe holds no --time-budget", *self.BAKE, "--time-budget", "1", "--print-recipe")
        self.refused(2, "time_budget: 0 is not in [0.001, 1e+06]", *self.BAKE, "--time-budget", "0", "-o", "x.exr")
        recipe = self.run_tool(*self.BAKE, "--target-error", "0.05", "--channels", "error,normal", "--print-recipe").stdout
        self.assertIn('target_error = 0.05\nchannels = ["normal", "error"]\n', recipe)
        self.file("hero.vismap", recipe)
        self.told(self.done("makevismap", "hero.vismap", "-o", "a.exr"))
        self.refused(2, "--time-budget 1: target_error says", "makevismap", "hero.vismap", "-o", "x.exr",
                     "--time-budget", "1")
        self.done("makevismap", "hero.vismap", "-o", "a.exr", "--target-error", "none", "--samples", "4")
        self.assertEqual(self.attribute("a.exr", "samples"), "4")
        self.file("time.vismap", "time_budget = 1\n")
        self.refused(1, 'unknown parameter "time_budget"', "makevismap", "time.vismap", "-o", "x.exr")


if __name__ == "__main__":
    unittest.main(argv=[sys.argv[0], *sys.argv[1:]])
