# SPDX-License-Identifier: Apache-2.0
"""What light does, seen from Python; and the same bytes as the executables.

Run as: laws_test.py, with VMLIGHT_SOURCE, VMLIGHT_BIN and the package on PYTHONPATH"""
import os
import re
import shutil
import subprocess
import sys
import textwrap
import unittest

import numpy as np

import vmlight
from scenes import SPOT, STUDIO, Case, latlong_directions, pit, plane, sky, wall

BIN, SOURCE = os.environ["VMLIGHT_BIN"], os.environ["VMLIGHT_SOURCE"]


class Laws(Case):
    def test_an_open_plane_sees_everything(self):
        vismap = vmlight.make_vismap(plane(), resolution=16)
        self.assertEqual(vismap.channels, ("visibility", "direction.x", "direction.y", "direction.z"))
        self.assert_same(vismap["visibility"], np.ones((16, 16), np.float32))
        self.assert_same(vismap["direction"], np.broadcast_to(np.float32([0, 2 / 3, 0]), (16, 16, 3)))

    def test_a_wall_without_end_hides_half(self):
        # Of a floor at its foot: V = 1/2 and B = (2 / (3 pi), 1/3, 0), each half of the hemisphere's integral.
        floor = vmlight.Mesh(np.array([(0, 0, 1e-4), (2e-4, 0, 1e-4), (2e-4, 0, -1e-4), (0, 0, -1e-4)]),
                             [(0, 1, 2), (0, 2, 3)], np.float32([(0, 0), (1, 0), (1, 1), (0, 1)]))
        vismap = vmlight.make_vismap(floor, wall(), resolution=8, samples=1024)
        self.assertLess(abs(vismap["visibility"].mean() - 0.5), 2e-3)
        self.assertLess(np.abs(vismap["direction"].mean((0, 1)) - (2 / (3 * np.pi), 1 / 3, 0)).max(), 2e-3)

    def test_a_pit_has_the_form_factor_of_its_opening(self):
        # Of a square of side a at height h over its centre: 4 corners of (1/2 pi) 2 s atan(s), s = 1 / sqrt(1 + 4).
        floor = plane(1e-3)
        vismap = vmlight.make_vismap(floor, pit(), resolution=8, samples=4096)
        s = 1 / np.sqrt(5)
        self.assertLess(abs(vismap["visibility"].mean() - 4 / (2 * np.pi) * 2 * s * np.arctan(s)), 2e-3)

    def test_constant_light_gives_visibility_times_light(self):
        color = np.float32([0.25, 1, 3])
        furnace = np.broadcast_to(color, (16, 32, 3))
        vismap = vmlight.make_vismap(plane(), pit(), resolution=16, samples=64, basis="sh")
        filtered = vmlight.make_cfem(furnace)
        np.testing.assert_allclose(filtered.pixels, np.broadcast_to(color, (64, 128, 3)), rtol=1e-6)
        for model in "paper", "lobe", "sh":
            lit = vmlight.make_lightmap(vismap, furnace, model=model, rotate=(10, 20, 30))
            np.testing.assert_allclose(lit.pixels, vismap["visibility"][..., None] * color, rtol=1e-5, atol=1e-6)

    def test_the_cosine_filter_of_a_band(self):
        # L = 1 + d.y / 2 has C(n) = 1 + (2/3) n.y / 2.
        sharp, filtered = sky(512, 256), vmlight.make_cfem(sky(512, 256), resolution=(32, 16))
        self.assertEqual(sharp.dtype, np.float32)
        np.testing.assert_allclose(filtered.pixels, 1 + latlong_directions(32, 16) / 3, atol=2e-4)

    def test_a_stack_begins_with_the_filtered_map(self):
        stack = vmlight.make_cfem(sky(), stack=True)
        self.assertEqual(len(stack.subimages), 10)
        self.assert_same(stack, vmlight.make_cfem(sky()))
        self.assert_same(stack.subimages[0], stack)

    def test_a_rotation_turns_the_light(self):
        vismap = vmlight.make_vismap(plane(), resolution=4)
        # Light of +x only. Turned by 90 degrees about z, the plane's +y looks to -x.
        light = np.maximum(latlong_directions(64, 32)[..., :1] * [1, 1, 1], 0).astype(np.float32)
        facing = vmlight.make_lightmap(vismap, light, rotate=(0, 0, -90)).pixels.mean()
        away = vmlight.make_lightmap(vismap, light, rotate=(0, 0, 90)).pixels.mean()
        self.assertLess(abs(facing - 2 / 3), 5e-3)
        self.assertLess(abs(away), 5e-3)
        matrix = [[0, 1, 0], [-1, 0, 0], [0, 0, 1]]  # by -90 degrees about z
        np.testing.assert_allclose(vmlight.make_lightmap(vismap, light, matrix=matrix).pixels.mean(), facing, rtol=1e-5)

    def test_the_reference_agrees_with_an_exact_model(self):
        # An open plane is exact by every model.
        traced = vmlight.make_reference(plane(), sky(), resolution=8, samples=256)
        lit = vmlight.make_lightmap(vmlight.make_vismap(plane(), resolution=8), sky())
        self.assertEqual(traced.channels, ("R", "G", "B", "error.R", "error.G", "error.B", "coverage"))
        error = np.abs(traced.pixels[..., :3] - lit.pixels) / np.maximum(traced["error"], 1e-6)
        self.assertLess(error.max(), 6)

    def test_albedo_and_exposure_multiply(self):
        vismap = vmlight.make_vismap(plane(), resolution=8)
        lit = vmlight.make_lightmap(vismap, sky())
        albedo = np.linspace(0, 1, 64, dtype=np.float32).reshape(8, 8)
        np.testing.assert_allclose(vmlight.make_lightmap(vismap, sky(), albedo).pixels,
                                   lit.pixels * albedo[..., None], rtol=1e-6)
        np.testing.assert_allclose(vmlight.make_lightmap(vismap, sky(), exposure=1).pixels, 2 * lit.pixels, rtol=1e-6)

    def test_a_mesh_of_arrays_is_that_of_its_file(self):
        from_file = vmlight.make_vismap(SPOT, resolution=64, samples=16)
        mesh = vmlight.Mesh.read(SPOT)
        self.assert_same(vmlight.make_vismap(mesh, resolution=64, samples=16), from_file)
        copy = vmlight.Mesh(mesh.positions.astype(np.float32), mesh.triangles, mesh.uvs, mesh.normals)
        self.assert_same(vmlight.make_vismap(copy, resolution=64, samples=16), from_file)

    def test_an_unwrapped_mesh_fills_its_map(self):
        mesh = vmlight.Mesh(plane().positions, plane().triangles).unwrap(resolution=32)
        self.assertEqual(vmlight.make_vismap(mesh, resolution=32, channels=["coverage"])["visibility"].max(), 1)


class SameBytes(Case):
    def run_tool(self, *arguments):
        result = subprocess.run([os.path.join(BIN, arguments[0]), *arguments[1:], "--quiet"], capture_output=True,
                                text=True, timeout=300)
        self.assertEqual(result.returncode, 0, result.stderr)

    def assert_same_files(self, first, second):
        with open(first, "rb") as one, open(second, "rb") as other:
            self.assertEqual(one.read(), other.read(), f"{first} and {second} differ")

    def test_files_are_those_of_the_executables(self):
        folder = self.folder()

        def path(name):
            return os.path.join(folder, name)

        self.run_tool("makevismap", SPOT, "-o", path("vismap.exr"), "--resolution", "64", "--samples", "16", "--basis", "sh",
                      "--order", "4", "--format", "half")
        vmlight.make_vismap(SPOT, resolution=64, samples=16, basis="sh", order=4).write(path("vismap.py.exr"), format="half")
        self.assert_same_files(path("vismap.exr"), path("vismap.py.exr"))

        self.run_tool("makecfem", STUDIO, "--stack", "--resolution", "64x32", "-o", path("cfem.exr"))
        vmlight.make_cfem(STUDIO, stack=True, resolution=(64, 32)).write(path("cfem.py.exr"))
        self.assert_same_files(path("cfem.exr"), path("cfem.py.exr"))

        self.run_tool("makelightmap", path("vismap.exr"), STUDIO, "--rotate", "0,90,0", "--exposure", "-1", "-o",
                      path("lit.exr"))
        vmlight.make_lightmap(path("vismap.exr"), STUDIO, rotate=(0, 90, 0), exposure=-1).write(path("lit.py.exr"))
        self.assert_same_files(path("lit.exr"), path("lit.py.exr"))
        vmlight.Relighter(path("vismap.exr"), STUDIO).light(rotate=(0, 90, 0), exposure=-1).write(path("lit.again.exr"))
        self.assert_same_files(path("lit.exr"), path("lit.again.exr"))

        # The same pixels from what is in memory.
        vismap = vmlight.Image.read(path("vismap.exr"))
        lit = vmlight.Image.read(path("lit.exr"))
        for light in STUDIO, vmlight.make_cfem(STUDIO, stack=True):
            self.assert_same(vmlight.make_lightmap(vismap, light, rotate=(0, 90, 0), exposure=-1), lit)


class Documentation(Case):
    def test_the_code_of_the_page_runs(self):
        with open(os.path.join(SOURCE, "docs/python.md")) as file:
            blocks = re.findall(r"^\n((?:    .*\n)+)", file.read(), re.MULTILINE)
        code = "\n".join(textwrap.dedent(block) for block in blocks if "python3" not in block).replace("1024", "32")
        self.assertIn("Relighter(", code)
        folder = self.folder()
        for source, name in (SPOT, "hero.obj"), (STUDIO, "studio.hdr"):
            shutil.copy(source, os.path.join(folder, name))
        vmlight.make_vismap(SPOT, resolution=8).write(os.path.join(folder, "hero_vismap.exr"))
        self.addCleanup(os.chdir, os.getcwd())
        os.chdir(folder)
        names = {}
        exec(code, names)
        self.assertEqual(names["lightmap"].pixels.shape, (8, 8, 3))
        self.assertTrue(os.path.exists("hero_lit.exr"))

    @unittest.skipUnless(shutil.which("gnuplot"), "gnuplot is not installed")
    def test_the_example_plots(self):
        picture = os.path.join(self.folder(), "error.png")
        result = subprocess.run([sys.executable, os.path.join(SOURCE, "docs/error_against_rays.py"), SPOT, STUDIO, picture, "32",
                                 "64"], capture_output=True, text=True, timeout=300)
        self.assertEqual(result.returncode, 0, result.stderr)
        head, *rows = [line.split() for line in result.stdout.splitlines()]
        self.assertEqual(head, ["rays", "paper", "lobe", "sh", "visibility"])
        self.assertEqual([int(row[0]) for row in rows], [4, 8, 16, 32, 64])
        # With few rays they are what counts: 16 times as many leave at most a third of the error of V.
        self.assertLess(float(rows[-1][-1]), float(rows[0][-1]) / 3)
        with open(picture, "rb") as file:
            self.assertEqual(file.read(8), b"\x89PNG\r\n\x1a\n")


if __name__ == "__main__":
    unittest.main()
