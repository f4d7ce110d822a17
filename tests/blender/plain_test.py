# SPDX-License-Identifier: Apache-2.0
"""What the add-on for Blender does without Blender: paths, commands, messages, processes, rotations, colour spaces, its zip.

Run as: plain_test.py, with VMLIGHT_SOURCE (the repository), VMLIGHT_ADDON (the zip) and VMLIGHT_VERSION."""
import ast
import hashlib
import itertools
import math
import os
import re
import stat
import subprocess
import sys
import tempfile
import threading
import time
import unittest
import zipfile

SOURCE = os.environ["VMLIGHT_SOURCE"]
ADDON = os.path.join(SOURCE, "configs/blender/vmlight_addon")
sys.dont_write_bytecode = True
sys.path.insert(0, os.path.dirname(ADDON))

from vmlight_addon import color_spaces, job, messages, orientation, recipe, tools  # noqa: E402


def executable(folder, name, text="#!/bin/sh\n"):
    os.makedirs(folder, exist_ok=True)
    path = os.path.join(folder, name)
    with open(path, "w") as file:
        file.write(text)
    os.chmod(path, os.stat(path).st_mode | stat.S_IXUSR)
    return path


class InFolder(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory(prefix="vmlight-addon-")
        self.addCleanup(folder.cleanup)
        self.folder = folder.name

    def path(self, *names):
        return os.path.join(self.folder, *names)


class Orientation(unittest.TestCase):
    def assert_same(self, a, b, places=9):
        for x, y in zip(itertools.chain(*a), itertools.chain(*b)):
            self.assertAlmostEqual(x, y, places)

    @staticmethod
    def blender_uv(x, y, z):
        """Where Cycles looks up a direction (kernel/util/projection: direction_to_equirectangular)."""
        return 0.5 - math.atan2(y, x) / (2 * math.pi), 0.5 + math.atan2(z, math.hypot(x, y)) / math.pi

    @staticmethod
    def vmlight_st(x, y, z):
        """The inverse of (-sin phi sin theta, cos theta, cos phi sin theta), phi = 2 pi (s - 1/2), theta = pi t."""
        return 0.5 + math.atan2(-x, z) / (2 * math.pi), math.acos(y) / math.pi

    def assert_same_texel(self, direction, mapping=orientation.IDENTITY, turn=orientation.IDENTITY):
        """A direction of an object's surface, in Blender's axes when it was baked, finds the same point of the map."""
        u, v = self.blender_uv(*orientation.apply(mapping, orientation.apply(turn, direction)))
        x, y, z = direction
        rotation = orientation.from_angles(*orientation.rotate_for_vmlight(mapping, turn))
        s, t = self.vmlight_st(*orientation.apply(rotation, (x, z, -y)))
        self.assertAlmostEqual((u - s + 0.5) % 1, 0.5, 6)
        self.assertAlmostEqual(v, 1 - t, 6)

    DIRECTIONS = [(0.48, 0.6, 0.64), (-0.48, 0.6, -0.64), (0.6, -0.64, 0.48), (-0.6, -0.48, 0.64)]

    def test_an_unturned_world_is_a_quarter_turn_from_ours(self):
        self.assertEqual(orientation.rotate_for_vmlight(), (0, -90, 0))

    def test_a_mapping_of_90_degrees_about_z_is_no_rotation_of_ours(self):
        quarter = orientation.mapping_rotation("POINT", (0, 0, math.radians(90)))
        self.assertEqual(orientation.rotate_for_vmlight(quarter), (0, 0, 0))

    def test_every_mapping_finds_the_texel_that_cycles_finds(self):
        for angles in (0, 0, 0), (0, 0, 35), (35, 0, 0), (0, 35, 0), (20, -35, 110), (0, 90, 0), (15, 90, 40), (15, -90, 0):
            for kind in "POINT", "TEXTURE", "VECTOR", "NORMAL":
                mapping = orientation.mapping_rotation(kind, [math.radians(angle) for angle in angles])
                for direction in self.DIRECTIONS:
                    with self.subTest(angles=angles, kind=kind, direction=direction):
                        self.assert_same_texel(direction, mapping)

    def test_a_turned_object_stays_under_the_same_sky(self):
        turn, mapping = orientation.from_angles(10, 20, 30), orientation.from_angles(40, 50, 60)
        for direction in self.DIRECTIONS:
            self.assert_same_texel(direction, mapping, turn)

    def test_texture_is_the_inverse_of_point(self):
        radians = (0.3, 0.4, 0.5)
        both = orientation.multiply(*(orientation.mapping_rotation(kind, radians) for kind in ("POINT", "TEXTURE")))
        self.assert_same(both, orientation.IDENTITY)

    def test_angles_and_matrices_are_the_same(self):
        for angles in itertools.product((-170, -90, 0, 33, 90), (-90, -60, 0, 45, 90), (-120, 0, 90, 180)):
            rotation = orientation.from_angles(*angles)
            self.assert_same(orientation.from_angles(*orientation.to_angles(rotation)), rotation)
        self.assert_same(orientation.from_angles(0, 0, 90), ((0, -1, 0), (1, 0, 0), (0, 0, 1)))
        half = math.sqrt(0.5)
        self.assert_same(orientation.from_quaternion(half, 0, 0, half), orientation.from_angles(0, 0, 90))

    def test_a_mapping_that_is_no_rotation_is_refused(self):
        self.assertEqual(orientation.mapping_fault("POINT", (0, 0, 0), (2, 2, 2)), "")
        self.assertEqual(orientation.mapping_fault("NORMAL", (1, 0, 0), (1, 1, 1)), "")  # which Blender ignores
        self.assertIn("moves the map by 0, 0, 0.5: set Location to 0",
                      orientation.mapping_fault("TEXTURE", (0, 0, 0.5), (1, 1, 1)))
        for scale in (1, 1, -1), (-1, -1, -1), (1, 2, 1), (0, 0, 0):
            self.assertIn("set Scale to 1", orientation.mapping_fault("POINT", (0, 0, 0), scale))


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


class Jobs(InFolder):
    def run_script(self, *texts):
        steps = [job.Step(f"part {number}", [executable(self.folder, f"tool{number}", "#!/bin/sh\n" + text)])
                 for number, text in enumerate(texts)]
        return job.run(steps, 60)

    def test_steps_run_in_order_and_what_they_say_is_kept(self):
        done = self.run_script('echo "tool0 WARNING: thin"; echo note >&2', "touch $(dirname $0)/made")
        self.assertEqual((done.error, done.fraction), ("", 1))
        self.assertEqual(sorted(done.log), [("INFO", "note"), ("WARNING", "thin")])
        self.assertTrue(os.path.exists(self.path("made")))

    def test_a_failure_ends_it_with_the_tools_own_words(self):
        done = self.run_script('echo "tool0 ERROR: \\"a.exr\\": full" >&2; exit 1', "touch $(dirname $0)/made")
        self.assertEqual(done.error, '"a.exr": full')
        self.assertFalse(os.path.exists(self.path("made")))
        self.assertEqual(self.run_script("exit 3").error, "tool0 ended with code 3")
        self.assertEqual(self.run_script("kill -9 $$").error, "tool0 ended with signal 9")
        self.assertIn("No such file", job.run([job.Step("", ["/nowhere/tool"])]).error)

    def test_messages_do_not_name_temporary_files(self):
        tool = executable(self.folder, "tool", "#!/bin/sh\necho \"tool ERROR: \\\"$1\\\": too small\"; exit 1\n")
        self.assertEqual(job.run([job.Step("Cube", [tool, "/tmp/a b.glb"])], 60).error, '"Cube": too small')

    def wait_for(self, is_true):
        end = time.monotonic() + 60
        while not is_true():
            self.assertLess(time.monotonic(), end)
            time.sleep(0.01)

    def test_progress_counts_all_steps(self):
        fifo = self.path("fifo")
        os.mkfifo(fifo)
        waits = executable(self.folder, "waits", f'#!/bin/sh\nprintf "\\rbake  50 %%  1 texels/s"; printf "\\r" ; cat {fifo}\n')
        running = job.Job([job.Step("a", [waits]), job.Step("b", [waits])]).start()
        for fraction in 0.25, 0.75:
            self.wait_for(lambda: running.fraction == fraction)
            self.assertIn("bake: 1 texels/s", running.line)
            with open(fifo, "w"):
                pass
        self.assertEqual(running.wait().fraction, 1)

    def test_the_tools_take_it_for_a_terminal(self):
        """Otherwise progress would come in tenths only."""
        self.assertEqual(self.run_script("test -t 2 && test -t 1").error, "")

    def test_cancel_ends_the_process(self):
        for stubborn in "", 'trap "" TERM\n':
            waits = executable(self.folder, "waits", f"#!/bin/sh\n{stubborn}echo started\nwhile true; do sleep 0.05; done\n")
            running = job.Job([job.Step("a", [waits]), job.Step("b", [waits])]).start()
            self.wait_for(lambda: running.log)
            running.cancel()
            self.assertTrue(running.finished)
            self.assertIsNotNone(running._process.poll())
            self.assertEqual((running.cancelled, running.error, len(running.log)), (True, "", 1))

    def test_cancel_before_the_start_starts_nothing(self):
        running = job.Job([job.Step("a", [executable(self.folder, "tool", "#!/bin/sh\ntouch $(dirname $0)/made\n")])])
        running.cancelled = True
        running.start().wait()
        self.assertFalse(os.path.exists(self.path("made")))

    def test_a_job_that_takes_too_long_is_ended(self):
        waits = executable(self.folder, "waits", "#!/bin/sh\nwhile true; do sleep 0.05; done\n")
        self.assertIn("not done within 0.2 s", job.run([job.Step("a", [waits])], 0.2).error)
        self.assertFalse([thread for thread in threading.enumerate() if thread.name == "vmlight"])


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
        loaded = {name for name in sys.modules if name.startswith("vmlight_addon.")}
        self.assertEqual(loaded, {f"vmlight_addon.{name}" for name in
                                  ("color_spaces", "job", "messages", "orientation", "recipe", "tools")})
        self.assertNotIn("bpy", sys.modules)


if __name__ == "__main__":
    unittest.main(verbosity=1)
