# SPDX-License-Identifier: Apache-2.0
"""Arguments that are files: their names, and files beside what is in memory.

Run as: files_test.py, with VMLIGHT_SOURCE and the package on PYTHONPATH"""
import os
import pathlib
import unittest

import numpy as np

import vmlight
from scenes import SPOT, STUDIO, Case, plane, sky


class Names(Case):
    def test_names_and_paths_are_one_or_several(self):
        mesh = os.path.join(self.folder(), "room.obj")
        with open(mesh, "w") as file:
            file.write("v 0 0 0\nv 1 0 0\nv 0 1 0\nvt 0 0\nvt .5 0\nvt 0 .5\nvt .5 1\nvt 1 .5\nvt 1 1\n"
                       "vn 0 0 1\no Floor\nf 1/1/1 2/2/1 3/3/1\no Roof\nf 3/4/1 2/5/1 1/6/1\n")
        floor = vmlight.make_vismap(mesh, resolution=4, samples=1, node="Floor")
        self.assertEqual(floor.metadata["vmlight:node"], "Floor")
        self.assert_same(vmlight.make_vismap(mesh, resolution=4, samples=1, node=["Floor"]), floor)
        both = vmlight.make_vismap(mesh, resolution=4, samples=1, node=("Floor", "Roof"))
        self.assertEqual(both.metadata["vmlight:node"], "Floor\nRoof")
        shaded = vmlight.make_vismap(mesh, occluder=[SPOT, pathlib.Path(mesh)], resolution=4, samples=1)
        self.assertEqual(shaded.metadata["vmlight:occluder"], "spot.obj, room.obj")
        config = os.path.join(os.environ["VMLIGHT_SOURCE"], "configs/ocio/config.ocio")
        for path in config, pathlib.Path(config):
            image = vmlight.make_cfem(STUDIO, resolution=8, colorconfig=path, colorspace="ACEScg")
            self.assertEqual(image.metadata["colorInteropID"], "lin_ap1_scene")
        for arguments, error, text in [
            (dict(node=3), TypeError, "^node: must be names, not int$"),
            (dict(node=[3]), TypeError, "^node: must be str, not int$"),
            (dict(node=[""]), ValueError, "^node: '' is empty; leave it out$"),
            (dict(node="a\nb"), ValueError, "^node: .* has a line break, which vmlight cannot pass on$"),
            (dict(node="\udcff"), ValueError, "surrogates"),
            (dict(normal_map=3), TypeError, "^normal_map: must be a path, not int$"),
            (dict(resolution=[4, 4.5]), TypeError, r"^resolution: must be int, or \(width, height\), not float$"),
            (dict(channels=3), TypeError, "^channels: must be words, not int$"),
        ]:
            with self.subTest(arguments=arguments), self.assertRaisesRegex(error, text):
                vmlight.make_vismap(mesh, **arguments)


class FilesAndArrays(Case):
    """What is a file and what is in memory may be mixed: the lightmap is that of files alone."""
    def setUp(self):
        folder = self.folder()
        self.vismap, self.cfem, self.stack, self.albedo = (os.path.join(folder, name + ".exr")
                                                           for name in ("vm", "cfem", "stack", "albedo"))
        vmlight.make_vismap(plane(), resolution=8, basis="sh").write(self.vismap)
        vmlight.make_cfem(STUDIO, resolution=16).write(self.cfem)
        vmlight.make_cfem(STUDIO, resolution=16, stack=True).write(self.stack)
        paint = np.linspace(0.1, 0.9, 8 * 8 * 3, dtype=np.float32).reshape(8, 8, 3)
        vmlight.Image(paint, metadata={"colorInteropID": "lin_rec709_scene"}).write(self.albedo)

    def test_all_mixtures(self):
        read = vmlight.Image.read
        for light, arguments in ((self.cfem, dict(model="paper")), (self.stack, {}), (STUDIO, dict(cfem_resolution=16)),
                                 (STUDIO, dict(model="paper", cfem_resolution=16))):
            whole = vmlight.make_lightmap(self.vismap, light, self.albedo, **arguments)
            for mixture in ((read(self.vismap), light, self.albedo), (self.vismap, read(light), self.albedo),
                            (self.vismap, light, read(self.albedo)), (read(self.vismap), read(light), read(self.albedo))):
                with self.subTest(light=os.path.basename(light), kinds=[type(item).__name__ for item in mixture]):
                    lit = vmlight.make_lightmap(*mixture, **arguments)
                    self.assertEqual(lit.channels, whole.channels)
                    np.testing.assert_allclose(lit.pixels, whole.pixels, rtol=1e-5, atol=1e-6)

    def test_faults_of_files_name_them(self):
        for call, error, text in [
            (lambda: vmlight.make_lightmap(self.cfem, sky()), vmlight.Error, "cfem.exr"),
            (lambda: vmlight.make_lightmap(self.vismap, vmlight.Image(-sky())), vmlight.Error, "; set cfem_sanitize to repair"),
            (lambda: vmlight.make_lightmap(self.vismap, vmlight.Image(-sky()), model="paper"), vmlight.Error,
             "; set cfem_sanitize to repair"),
            (lambda: vmlight.make_lightmap(vmlight.Image.read(self.vismap), self.vismap), vmlight.Error, "vm.exr"),
            (lambda: vmlight.make_lightmap(vmlight.Image.read(self.vismap), self.cfem, self.vismap + ".none"),
             FileNotFoundError, "vm.exr.none"),
        ]:
            with self.subTest(text=text), self.assertRaisesRegex(error, text):
                call()

    def test_a_recipe_is_a_file(self):
        path = os.path.join(os.path.dirname(self.vismap), "studio.cfem")
        with open(path, "w") as file:
            file.write(f'environment = "{STUDIO}"\nresolution = "16x8"\n')
        vismap = vmlight.Image.read(self.vismap)
        self.assert_same(vmlight.make_lightmap(vismap, path, model="paper"),
                         vmlight.make_lightmap(vismap, self.cfem, model="paper"))


if __name__ == "__main__":
    unittest.main()
