# SPDX-License-Identifier: Apache-2.0
"""What the add-on for Blender does without Blender: paths, commands, messages, colour spaces, its zip.

Run as: plain_test.py, with VMLIGHT_SOURCE (the repository), VMLIGHT_ADDON (the zip) and VMLIGHT_VERSION."""
import ast
import hashlib
import importlib
import os
import re
import subprocess
import sys
import unittest
import zipfile

from plain_support import ADDON, SOURCE, InFolder, executable
from vmlight_addon import color_spaces, messages, orientation, recipe, tools


class ColorSpaces(InFolder):
    def test_the_working_space_is_found_by_its_role_and_else_by_its_name(self):
        self.assertEqual(color_spaces.scene_linear_names(self.path("none"))[:2], ["Linear", "Linear Rec.709"])
        for written in "ACEScg", '"ACEScg"', "'ACEScg'  ":
            with open(self.path("config.ocio"), "w") as file:
                file.write(f"roles:\n  reference: Linear\n  scene_linear: {written}\n  rendering: Linear\n")
            self.assertEqual(color_spaces.scene_linear_names(self.path("config.ocio"))[0], "ACEScg")

    def test_blenders_names_are_ours(self):
        for theirs, ours in (("Linear", "lin_rec709_scene"), ("Linear Rec.709", "lin_rec709_scene"),
                             ("Linear ACEScg", "lin_ap1_scene"), ("sRGB", "srgb_rec709_scene"), ("Non-Color", "lin_rec709_scene")):
            self.assertEqual(color_spaces.vmlight_name(theirs, False), (ours, ""))
        self.assertEqual(color_spaces.vmlight_name("Raw", True), ("scene_linear", ""))
        self.assertEqual(color_spaces.vmlight_name("studio gamut", True), ("studio gamut", ""))
        name, fault = color_spaces.vmlight_name("Filmic Log", False)
        self.assertEqual(name, "")
        self.assertIn('"Filmic Log" is unknown to vmlight: choose Linear', fault)


class Messages(unittest.TestCase):
    def test_lines_are_sorted(self):
        for line, kind, text in (
                ("bake  30 %  2.53 M texels/s  00:03 left", "PROGRESS", "bake: 2.53 M texels/s 00:03 left"),
                ("bake, tile 1002   0 %  0 texels/s  --:-- left", "PROGRESS", "bake, tile 1002: 0 texels/s --:-- left"),
                ('makevismap ERROR: "nope.obj": no such file', "ERROR", '"nope.obj": no such file'),
                ("makevismap WARNING: 17 texels (0.02 % of them) are shared", "WARNING", "17 texels (0.02 % of them) are shared"),
                ("uv: 968 triangles cover 42.9 % of 512x512 texels", "INFO", "uv: 968 triangles cover 42.9 % of 512x512 texels")):
            message = messages.parse(line)
            self.assertEqual((message.kind, message.text), (kind, text))
        self.assertIsNone(messages.parse("  "))
        self.assertEqual(messages.parse("bake  30 %  2.53 M texels/s").fraction, 0.3)

    def test_a_stream_is_cut_anywhere(self):
        stream = "\rbake  10 %  5 texels/s  \rbake 100 %  5 texels/s\r\nmake WARNING: \u00e4\r\nend".encode()
        whole = messages.Lines()
        expected = [repr(m) for m in whole.feed(stream) + whole.end()]
        self.assertEqual(len(expected), 4)
        for size in 1, 2, 3, 7:
            lines, seen = messages.Lines(), []
            for start in range(0, len(stream), size):
                seen += lines.feed(stream[start:start + size])
            self.assertEqual([repr(m) for m in seen + lines.end()], expected)

    def test_long_text_is_wrapped_for_the_panel(self):
        self.assertEqual(messages.wrapped("no mesh is selected: select", 20), ["no mesh is selected:", "select"])
        self.assertTrue(all(len(line) <= 16 for line in messages.wrapped("/a/path/without/any/blank/in/it", 3)))
        self.assertEqual(messages.wrapped("", 40), [""])


class Tools(InFolder):
    def test_executables_are_found_in_order(self):
        preferred = executable(self.path("preferred"), "makevismap")
        in_path = executable(self.path("path"), "makevismap")
        beside = executable(self.path("beside", "bin"), "makevismap")

        def find(preferred="", search_path=""):
            return tools.find("makevismap", preferred, search_path or self.path("none"), self.path("beside"))

        self.assertEqual(find(self.path("preferred"), self.path("path")), preferred)
        self.assertEqual(find(self.path("beside"), self.path("path")), beside)  # its bin
        self.assertEqual(find("", self.path("path")), in_path)
        self.assertEqual(find(), beside)

    def test_what_is_missing_says_what_to_do(self):
        with self.assertRaisesRegex(tools.Missing, "vmframes is not installed: install vmlight, and set its folder in the "
                                                   "add-on's preferences, or add it to"):
            tools.find("vmframes", "", self.path("none"), self.folder)
        # No other version takes the place of the preferred one.
        executable(self.path("path"), "makevismap")
        with self.assertRaisesRegex(tools.Missing, 'makevismap is not in "/nowhere", the folder in the add-on\'s preferences'):
            tools.find("makevismap", "/nowhere", self.path("path"), self.folder)
        with open(self.path("makecfem"), "w"):
            pass  # not executable
        with self.assertRaises(tools.Missing):
            tools.find("makecfem", self.folder)

    def test_readers_are_found_in_build_and_install_trees(self):
        for place in "plugins", "lib/vmlight", "lib/x86_64-linux-gnu/vmlight":
            top = self.path(place.replace("/", "_"))
            program = executable(os.path.join(top, "bin"), "makelightmap")
            self.assertEqual(tools.readers_folder(program), "")
            executable(os.path.join(top, place), "lightmap.imageio.so")
            self.assertEqual(tools.readers_folder(program), os.path.join(top, place))

    def test_names_make_safe_files(self):
        for name, expected in (("Cube.001", "Cube.001"), ("a/b?c*d", "a_b_c_d"), (".hidden", "_hidden"), ("", "_"),
                               ("\u00dcber <UDIM>", "\u00dcber__UDIM_"), ("..", "_.")):
            self.assertEqual(tools.file_name(name), expected)

    def test_two_objects_never_share_a_file(self):
        taken = {"cube_vismap.exr"}
        self.assertEqual([tools.unused_name(name, "_vismap.exr", taken) for name in ("cube", "a/b", "a?b", "a_b", "cube")],
                         ["cube_2_vismap.exr", "a_b_vismap.exr", "a_b_2_vismap.exr", "a_b_3_vismap.exr", "cube_3_vismap.exr"])

    OPTIONS = {"resolution": 512, "samples": 64, "margin": 8, "basis": "sh", "max_distance": 0}

    def test_commands(self):
        self.assertEqual(" ".join(tools.bake_command("makevismap", "s.glb", "Cube", "o.exr", self.OPTIONS)),
                         "makevismap s.glb --node Cube -o o.exr --resolution 512 --samples 64 --margin 8 --basis sh "
                         "--channels normal,coverage")
        near = tools.bake_command("m", "s", "n", "o", {**self.OPTIONS, "max_distance": 2.5})
        self.assertEqual(near[-2:], ["--max-distance", "2.5"])
        self.assertEqual(" ".join(tools.unwrap_command("makevismap", "s.glb", "o.exr", "uv.glb", self.OPTIONS)),
                         "makevismap s.glb --unwrap --write-mesh uv.glb -o o.exr --resolution 512 --margin 8 --samples 1")
        light = {"rotate": (0, -90, 1 / 3), "exposure": -1.5, "model": "lobe", "colorspace": "lin_ap1_scene", "repair": False}
        self.assertEqual(" ".join(tools.light_command("makelightmap", "v.exr", "c.exr", "o.exr", light)),
                         "makelightmap v.exr c.exr -o o.exr --rotate 0,-90,0.333333333333 --exposure -1.5 --model lobe --quiet")
        self.assertEqual(" ".join(tools.filter_command("makecfem", "e.hdr", "c.exr", light)),
                         "makecfem e.hdr --stack -o c.exr --quiet --colorspace lin_ap1_scene")
        sky = orientation.inverse_angles(light["rotate"])
        both = orientation.multiply(orientation.from_angles(*sky), orientation.from_angles(*light["rotate"]))
        for row, unit in zip(both, orientation.IDENTITY):
            for a, b in zip(row, unit):
                self.assertAlmostEqual(a, b, 9)
        rest = " --turntable --env-rotate " + tools.numbers(sky) + " --exposure -1.5"
        one = tools.frames_command("vmframes", ["s.glb"], "e.hdr", "o.####.png", light, (1, 48), "v.exr", {})
        self.assertEqual(" ".join(one),
                         "vmframes s.glb e.hdr -o o.####.png --frames 1-48" + rest + " --vismap v.exr --colorspace lin_ap1_scene")
        self.assertEqual(" ".join(tools.frames_command("vmframes", ["a.glb", "b.glb"], "e.hdr", "o.png", light, (1, 2), "",
                                                       self.OPTIONS)),
                         "vmframes a.glb e.hdr -o o.png --frames 1-2" + rest + " --object b.glb --resolution 512 --samples 64 "
                         "--colorspace lin_ap1_scene")

    def test_recipes(self):
        plain = {"colorspace": "", "repair": False}
        text = recipe.text(self.path("maps", 'a"b.exr'), "/skies/sky.hdr", plain, self.folder)
        self.assertEqual(text, 'vismap = "maps/a\\"b.exr"\nenvironment = "/skies/sky.hdr"\n')
        self.assertIn('colorspace = "lin_ap1_scene"\ncfem_sanitize = true\n',
                      recipe.text("/a", "/b", {"colorspace": "lin_ap1_scene", "repair": True}, self.folder))
        light = {"rotate": (0, 45, 0), "exposure": 1.0, "model": "auto"}
        self.assertEqual(recipe.query("x.lightmap", light), "x.lightmap?rotate=0,45,0&exposure=1&model=auto")


class Package(InFolder):
    def test_the_zip_holds_the_add_on_and_the_same_bytes_each_time(self):
        again = self.path("again.zip")
        subprocess.run([sys.executable, os.path.join(SOURCE, "configs/blender/make_zip.py"), ADDON, again], check=True)
        hashes = []
        for path in os.environ["VMLIGHT_ADDON"], again:
            with open(path, "rb") as file:
                hashes.append(hashlib.sha256(file.read()).hexdigest())
        self.assertEqual(*hashes)
        with zipfile.ZipFile(again) as packed:
            names = packed.namelist()
            self.assertEqual({entry.date_time for entry in packed.infolist()}, {(1980, 1, 1, 0, 0, 0)})
        self.assertIn("vmlight_addon/__init__.py", names)
        self.assertIn("vmlight_addon/blender_manifest.toml", names)
        self.assertEqual(len(names), len([name for name in os.listdir(ADDON) if name.endswith((".py", ".toml"))]))

    def test_both_descriptions_give_the_projects_version(self):
        with open(os.path.join(ADDON, "__init__.py")) as file:
            tree = ast.parse(file.read())
        info = next(ast.literal_eval(node.value) for node in tree.body
                    if isinstance(node, ast.Assign) and node.targets[0].id == "bl_info")
        with open(os.path.join(ADDON, "blender_manifest.toml")) as file:
            manifest = dict(re.findall(r'^(\w+) = "(.*)"$', file.read(), re.MULTILINE))
        version = os.environ["VMLIGHT_VERSION"]
        self.assertEqual(".".join(map(str, info["version"])), version)
        self.assertEqual((manifest["version"], manifest["name"]), (version, info["name"]))
        for text in manifest["tagline"], manifest["files"]:  # Blender refuses longer ones
            self.assertLessEqual(len(text), 64)
        self.assertEqual((manifest["id"], manifest["schema_version"]), ("vmlight_addon", "1.0.0"))

    def test_modules_without_blender_import_none_of_it(self):
        for name in "color_spaces", "job", "messages", "orientation", "recipe", "tools":
            importlib.import_module("vmlight_addon." + name)
        self.assertNotIn("bpy", sys.modules)


if __name__ == "__main__":
    unittest.main(verbosity=1)
