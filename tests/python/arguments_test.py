# SPDX-License-Identifier: Apache-2.0
"""Arguments: what is accepted, what is refused and how, and that docstrings, stubs and functions agree.

Run as: arguments_test.py, with VMLIGHT_SOURCE and the package on PYTHONPATH"""
import ast
import importlib
import inspect
import math
import os
import pathlib
import re
import unittest
import warnings

import numpy as np

import vmlight
from vmlight import _vmlight
from scenes import SPOT, SQUARE, SQUARE_TRIANGLES, SQUARE_UVS, STUDIO, Case, plane, sky

TABLE = _vmlight._functions()


def function_of(name):
    owner = vmlight
    for part in name.split("."):
        owner = getattr(owner, part)
    return owner


def known_arguments():
    return {name for entry in TABLE.values() for name, _, _ in entry["keywords"]}


class Values(Case):
    def metadata(self, **arguments):
        return vmlight.make_vismap(plane(), **{"resolution": 4, "samples": 1, **arguments}).metadata

    def test_equal_values_of_all_types(self):
        for size in 6, np.int64(6), (6, 6), [6, np.uint8(6)], "6x6":
            self.assertEqual(self.metadata(resolution=size)["vmlight:resolution"], "6x6")
        for distance in 2, 2.0, np.float32(2), np.array(2.0):
            self.assertEqual(self.metadata(max_distance=distance)["vmlight:max_distance"], "2")
        for distance in "infinite", math.inf, np.float32("inf"):
            self.assertEqual(self.metadata(max_distance=distance)["vmlight:max_distance"], "infinite")
        for channels in ["coverage", "normal"], ("normal", "coverage"), "normal,coverage":
            self.assertEqual(self.metadata(channels=channels)["vmlight:channels"], "normal,coverage")
        for ground in True, np.bool_(True):
            self.assertEqual(self.metadata(ground=ground)["vmlight:ground"], "true")

    def test_floats_keep_all_bits(self):
        distance = 0.1 + 0.2
        self.assertEqual(float(self.metadata(max_distance=distance)["vmlight:max_distance"]), distance)

    def test_paths_of_all_types(self):
        image = vmlight.make_cfem(STUDIO, resolution=8)
        for path in pathlib.Path(STUDIO), STUDIO.encode(), os.fspath(STUDIO):
            self.assert_same(vmlight.make_cfem(path, resolution=8), image)
        name = os.path.join(os.fsencode(self.folder()), b"not \xff UTF-8.exr")
        image.write(name)
        self.assert_same(vmlight.Image.read(name), image)

    def test_rotations_of_all_shapes(self):
        relighter = vmlight.Relighter(vmlight.make_vismap(plane(), resolution=4), sky(), rotate=(0, 0, 90))
        turned = relighter.light()
        matrix = [[0, -1, 0], [1, 0, 0], [0, 0, 1]]
        for given in (dict(rotate=[0, 0, 90]), dict(rotate=np.array([0, 0, 90.0])), dict(matrix=matrix),
                      dict(matrix=np.array(matrix).reshape(9)), dict(quaternion=(math.sqrt(0.5), 0, 0, math.sqrt(0.5)))):
            np.testing.assert_allclose(relighter.light(**given).pixels, turned.pixels, rtol=1e-6)
        self.assertGreater(np.abs(relighter.light(rotate=()).pixels - turned.pixels).max(), 0.1)


class Refusals(Case):
    def test_values(self):
        for arguments, error, text in [
            (dict(samples=0), ValueError, r"^samples: 0 is not in \[1, 1048576\]$"),
            (dict(samples=10**30), ValueError, r"^samples: 10+ is not in"),
            (dict(samples=1.5), TypeError, "^samples: must be int, not float$"),
            (dict(samples="64"), TypeError, "^samples: must be int, not str$"),
            (dict(samples=True), TypeError, "^samples: must be int, not bool$"),
            (dict(samples=None), TypeError, "^samples: must be int, not NoneType$"),
            (dict(max_distance=math.nan), ValueError, '^max_distance: "nan" is not a number or "infinite"$'),
            (dict(max_distance="far"), TypeError, "^max_distance: must be float or 'infinite', not str$"),
            (dict(max_distance=1j), TypeError, "^max_distance: must be float or 'infinite', not complex$"),
            (dict(target_error=0), ValueError, 'did you mean "none"'),
            (dict(resolution=(4, 4, 4)), TypeError, r"^resolution: must be int, or \(width, height\), not tuple$"),
            (dict(resolution=0), ValueError, '^resolution: "0" is not WIDTH or WIDTHxHEIGHT'),
            (dict(resolution=4.0), TypeError, "^resolution: must be int"),
            (dict(basis="shh"), ValueError, '^basis: "shh" is not one of vector, sh, mask, cells$'),
            (dict(basis=3), TypeError, "^basis: must be str, not int$"),
            (dict(channels=["norml"]), ValueError, 'did you mean "normal"'),
            (dict(channels=[3]), TypeError, "^channels: must be str, not int$"),
            (dict(ground=1), TypeError, "^ground: must be bool, not int$"),
            (dict(sample=3), TypeError, r'^make_vismap\(\) has no argument "sample"; did you mean "samples"\?$'),
            (dict(xyzzy=3), TypeError, r'^make_vismap\(\) has no argument "xyzzy"$'),
            (dict(order=4), ValueError, "^order: only the basis sh uses it$"),
            (dict(threads=-1), ValueError, r"^threads: -1 is not in \[0, 1024\]$"),
            (dict(progress=3), TypeError, "^progress: must be callable, not int$"),
            (dict(unwrap=True), TypeError, "^unwrap: only for a mesh that is a file$"),
            (dict(sun_directions="\udcff"), ValueError, "surrogates"),
            (dict(sun_directions="up"), vmlight.Error, "up"),
        ]:
            with self.subTest(arguments=arguments), self.assertRaisesRegex(error, text):
                vmlight.make_vismap(plane(), **arguments)

    def test_operands(self):
        vismap = vmlight.make_vismap(plane(), resolution=4)
        for call, error, text in [
            (lambda: vmlight.make_vismap(), TypeError, r"^make_vismap\(\): mesh is missing$"),
            (lambda: vmlight.make_vismap(plane(), mesh=plane()), TypeError, "mesh is given twice"),
            (lambda: vmlight.make_vismap(plane(), (), 64), TypeError, "takes 2 positional arguments, but 3 were given"),
            (lambda: vmlight.make_vismap(3), TypeError, "^mesh: must be a path or vmlight.Mesh, not int$"),
            (lambda: vmlight.make_vismap(plane(), 3), TypeError, "int"),
            (lambda: vmlight.make_vismap(plane(), SPOT), TypeError, "both be files, or both in memory"),
            (lambda: vmlight.make_vismap(plane(), [3]), TypeError, "^occluder: must be paths or vmlight.Mesh, not int$"),
            (lambda: vmlight.make_vismap(SPOT, occluder=["a\nb"]), FileNotFoundError, "no such file"),
            (lambda: vmlight.make_vismap("absent.obj"), FileNotFoundError, '^"absent.obj": no such file$'),
            (lambda: vmlight.make_vismap("a\0b.obj"), ValueError, "^mesh: a name cannot contain a zero byte$"),
            (lambda: vmlight.make_vismap(STUDIO), vmlight.Error, "studio_small_03.hdr"),
            (lambda: vmlight.make_cfem("absent.exr"), FileNotFoundError, "absent.exr"),
            (lambda: vmlight.make_cfem("\udcff.exr"), FileNotFoundError, r'xff.exr": no such file'),
            (lambda: vmlight.Image(), TypeError, r"^Image\(\): pixels is missing$"),
            (lambda: vmlight.Image(sky(), channel=["R"]), TypeError, 'did you mean "channels"'),
            (lambda: vmlight.Image(sky(), channels="RGB"), TypeError, "^channels: must be a sequence of str, not str$"),
            (lambda: vmlight.Image(sky(), channels=[1, 2, 3]), TypeError, "^channels: must be str, not int$"),
            (lambda: vmlight.Image(sky(), metadata=3), TypeError, "^metadata: must be a dict, not int$"),
            (lambda: vmlight.Mesh(SQUARE), TypeError, r"^Mesh\(\): triangles is missing$"),
            (lambda: vmlight.Relighter(vismap), TypeError, r"^Relighter\(\): light is missing$"),
            (lambda: vmlight.make_cfem(SPOT), vmlight.Error, "spot.obj"),
            (lambda: vmlight.make_cfem(sky(), colorspace="ACEScg"), TypeError, "^colorspace: only for an environment that"),
            (lambda: vmlight.make_cfem(sky(), order=4), ValueError, "^order: only the filter sh uses it$"),
            (lambda: vmlight.make_cfem(vismap), vmlight.Error, "visibility map"),
            (lambda: vmlight.make_lightmap(vismap, "absent.exr"), FileNotFoundError, "absent.exr"),
            (lambda: vmlight.make_lightmap("absent.exr", sky()), FileNotFoundError, "absent.exr"),
            (lambda: vmlight.make_lightmap(vismap, sky(), "absent.exr"), FileNotFoundError, "absent.exr"),
            (lambda: vmlight.make_lightmap(sky(), sky()), vmlight.Error, "visibility"),
            (lambda: vmlight.make_lightmap(vismap, sky(), suns="auto"), TypeError, "^suns: only for .* files$"),
            (lambda: vmlight.make_lightmap(vismap, sky(), model="sh"), vmlight.Error, "sh"),
            (lambda: vmlight.make_lightmap(vismap, sky(), rotate=(0, 1)), ValueError, "^rotate: .* has 2 numbers, expected 3$"),
            (lambda: vmlight.make_lightmap(vismap, sky(), rotate=3), TypeError, "^rotate: must be 3 floats, not int$"),
            (lambda: vmlight.make_lightmap(vismap, sky(), matrix=np.ones(9)), ValueError, "rotation"),
            (lambda: vmlight.make_lightmap(vismap, sky(), rotate=(0, 0, 0), quaternion=(1, 0, 0, 0)), ValueError, "only one"),
            (lambda: vmlight.make_lightmap(vismap, vmlight.make_cfem(sky()), cfem_order=3), ValueError, "already filtered"),
            (lambda: vmlight.Relighter(vismap, sky()).light(model="ao"), TypeError, "no argument \"model\""),
            (lambda: vmlight.make_reference(plane(), sky(), samples=1), ValueError, r"^samples: 1 is not in \[2,"),
            (lambda: vmlight.make_reference(plane(), sky(), up="z"), TypeError, "^up: only for a mesh that is a file$"),
            (lambda: vmlight.make_reference(plane(), sky(), colorspace="x"), TypeError, "only for an environment that"),
        ]:
            with self.subTest(text=text), self.assertRaisesRegex(error, text):
                call()

    def test_meshes(self):
        far = SQUARE.copy()
        far[2, 1] = np.nan
        for arguments, error, text in [
            ((SQUARE[:, :2], SQUARE_TRIANGLES), ValueError, r"positions: must have the shape \(n, 3\), not \(4, 2\)"),
            ((SQUARE.astype(int), SQUARE_TRIANGLES), TypeError, "positions: must be an array of floats, not int64"),
            ((SQUARE, SQUARE_TRIANGLES.astype(float)), TypeError, "triangles: must be an array of integers, not float64"),
            ((SQUARE, [(0, 1, 4)]), ValueError, "triangles: triangle 0 uses vertex 4, but there are 4"),
            ((SQUARE, [(0, 1, -1)]), ValueError, "uses vertex -1"),
            ((SQUARE, [(0, 1, 2**32)]), ValueError, "uses vertex 4294967296"),
            ((SQUARE, SQUARE_TRIANGLES, SQUARE_UVS[:3]), ValueError, r"uvs: must have the shape \(4, 2\), not \(3, 2\)"),
            ((SQUARE, SQUARE_TRIANGLES, None, SQUARE[:3]), ValueError, "normals: must have the shape"),
            ((far, SQUARE_TRIANGLES), ValueError, "vertex 2 is not finite"),
        ]:
            with self.subTest(text=text), self.assertRaisesRegex(error, text):
                vmlight.Mesh(*arguments)
        with self.assertRaisesRegex(ValueError, r"crease_angle: 200.* is not in \[0, 180\]"):
            vmlight.Mesh(SQUARE, SQUARE_TRIANGLES, crease_angle=200)
        with self.assertRaisesRegex(vmlight.Error, "no triangles|no texture|UV"):
            vmlight.make_vismap(vmlight.Mesh(SQUARE, SQUARE_TRIANGLES))
        with self.assertRaises(vmlight.Error):
            vmlight.make_vismap(vmlight.Mesh(np.zeros((0, 3)), np.zeros((0, 3), int), np.zeros((0, 2))))

    def test_a_mesh_says_what_it_is(self):
        self.assertEqual(repr(plane()), '<vmlight.Mesh "plane" 2 triangles, 4 vertices>')
        bare = vmlight.Mesh(SQUARE, SQUARE_TRIANGLES)
        self.assertEqual(repr(bare), f'<vmlight.Mesh "{bare.name}" 2 triangles, 4 vertices, without UVs>')

    def test_missing_normals_are_smooth(self):
        self.assert_same(vmlight.Mesh(SQUARE, SQUARE_TRIANGLES).normals, np.broadcast_to(np.float32([0, 1, 0]), (4, 3)))
        normals = np.float32([(0, 2, 0), (0, 0, 0), (np.nan, 0, 0), (0, 1, 0)])
        self.assert_same(vmlight.Mesh(SQUARE, SQUARE_TRIANGLES, None, normals).normals, np.broadcast_to(np.float32([0, 1, 0]), (4, 3)))

    def test_warnings_name_the_caller(self):
        for call in (lambda: vmlight.make_vismap(SPOT, resolution=8, samples=1),):
            with warnings.catch_warnings(record=True) as caught:
                warnings.simplefilter("always")
                call()
            self.assertEqual({warning.category for warning in caught}, {vmlight.Warning})
            self.assertEqual({warning.filename for warning in caught}, {__file__})
        with warnings.catch_warnings():
            warnings.simplefilter("error")
            with self.assertRaisesRegex(vmlight.Warning, "outside"):
                vmlight.make_vismap(SPOT, resolution=8, samples=1)

    def test_what_the_work_says_is_logged(self):
        with self.assertLogs("vmlight", "INFO") as logs:
            vmlight.make_cfem(STUDIO, resolution=8)
        self.assertTrue(any("filter: " in line for line in logs.output), logs.output)


class Documents(Case):
    def stub(self):
        """{name: (names of all arguments, {name: default})} of the stub."""
        path = os.path.join(os.path.dirname(vmlight.__file__), "__init__.pyi")
        with open(path) as file:
            tree = ast.parse(file.read())
        found, classes = {}, {}
        for node in tree.body:
            if isinstance(node, ast.ClassDef):
                classes[node.name] = {item.name for item in node.body if isinstance(item, ast.FunctionDef)}
            for item, prefix in [(node, "")] + [(item, node.name + ".") for item in getattr(node, "body", [])]:
                if isinstance(item, ast.FunctionDef):
                    arguments = item.args.args + item.args.kwonlyargs
                    defaults = [None] * (len(item.args.args) - len(item.args.defaults)) + item.args.defaults
                    defaults += item.args.kw_defaults
                    names = [argument.arg for argument in arguments]
                    found[prefix + item.name] = {name: value and ast.literal_eval(value) for name, value in zip(names, defaults)}
        return found, classes

    def test_stub_docstring_and_function_agree(self):
        stub, _ = self.stub()
        self.assertGreaterEqual(len(TABLE), 10)
        for name, entry in TABLE.items():
            with self.subTest(name=name):
                known = {key: default and ast.literal_eval(default)
                         for key, _, default in entry["operands"] + entry["keywords"]}
                written = {key: value for key, value in stub[name].items() if key != "self"}
                self.assertEqual(written, known)
                self.assertEqual(list(written), list(known))
                function = function_of(name)
                if name.endswith("__init__"):
                    continue
                signature = inspect.signature(function).parameters
                shown = {key: None if value.default is value.empty else value.default for key, value in signature.items() if key != "self"}
                self.assertEqual(shown, known)
                for key in known:
                    self.assertIn(f"    {key}: ", function.__doc__)

    def test_a_method_has_the_signature_of_its_class(self):
        image = vmlight.Image(sky())
        self.assertEqual(list(inspect.signature(image.write).parameters), ["path", "format", "compression", "threads", "progress"])
        self.assertEqual(list(inspect.signature(vmlight.Image.write).parameters), ["self", "path", "format", "compression", "threads", "progress"])

    def test_stub_names_what_there_is(self):
        stub, classes = self.stub()
        for name, members in classes.items():
            there = {member for member in vars(getattr(vmlight, name)) if not member.startswith("_") or member in ("__init__", "__getitem__")}
            if name not in ("Error", "Warning"):
                self.assertEqual(members - {"__buffer__"}, there, name)
        public = {name for name in vars(vmlight) if not name.startswith("_") and not inspect.ismodule(getattr(vmlight, name))}
        self.assertEqual(public, set(vmlight.__all__))
        self.assertEqual(public, set(classes) | {name for name in stub if "." not in name})
        self.assertTrue(os.path.exists(os.path.join(os.path.dirname(vmlight.__file__), "py.typed")))

    def test_defaults_are_those_of_a_call_without_them(self):
        defaults = {key: ast.literal_eval(value) for key, _, value in TABLE["make_vismap"]["keywords"]}
        metadata = vmlight.make_vismap(plane(), **{key: defaults[key] for key in ("samples", "margin", "basis", "sampler",
                                                                             "max_distance", "target_error", "seed")},
                                       resolution=4).metadata
        self.assertEqual(metadata, vmlight.make_vismap(plane(), resolution=4).metadata)

    def test_words_are_explained(self):
        self.assertIn("'fibonacci': Fibonacci lattice", vmlight.make_vismap.__doc__)
        self.assertIn("1..1048576, default 64", vmlight.make_vismap.__doc__)
        self.assertIn("0..32768 or 'infinite', default 16", vmlight.make_vismap.__doc__)

    def test_texts_name_arguments_and_no_flags(self):
        for name in TABLE:
            flags = set(re.findall(r"--([a-z-]+)", function_of(name).__doc__ or ""))
            self.assertEqual({flag for flag in flags if flag.replace("-", "_") in known_arguments()}, set(), name)
        with self.assertRaisesRegex(vmlight.Error, "; set sanitize to|sanitize") as caught:
            vmlight.make_cfem(-sky())
        self.assertNotIn("--", str(caught.exception))

    def test_a_reloaded_module_works(self):
        before = vmlight.make_cfem(sky(), resolution=8)
        again = importlib.reload(vmlight)
        self.assert_same(again.make_cfem(before, resolution=8), vmlight.make_cfem(before, resolution=8))
        self.assertIsInstance(before, again.Image)


if __name__ == "__main__":
    unittest.main()
