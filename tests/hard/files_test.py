# SPDX-License-Identifier: Apache-2.0
"""Hard files: damaged, missing, of another kind, in the way, oddly named, too many."""
import json
import os
import random
import shutil
import socket
import struct
import sys
import unittest

from hard_files import QUAD, SMALL, HardCase

# The quad of QUAD, in other formats.
CORNERS = [(-1, -1, 0, 0, 0), (1, -1, 0, 1, 0), (1, 1, 0, 1, 1), (-1, 1, 0, 0, 1)]
PLY = """ply
format {} 1.0
element vertex 4
property float x
property float y
property float z
property float s
property float t
element face 2
property list uchar int vertex_indices
end_header
"""


def ply_text():
    return (PLY.format("ascii") + "".join("{} {} {} {} {}\n".format(*corner) for corner in CORNERS)
            + "3 0 1 2\n3 0 2 3\n").encode()


def ply_binary():
    return (PLY.format("binary_little_endian").encode() + b"".join(struct.pack("<5f", *corner) for corner in CORNERS)
            + struct.pack("<B3iB3i", 3, 0, 1, 2, 3, 0, 2, 3))


def gltf_buffer():
    return (b"".join(struct.pack("<3f", *corner[:3]) for corner in CORNERS)
            + b"".join(struct.pack("<2f", *corner[3:]) for corner in CORNERS) + struct.pack("<6H", 0, 1, 2, 0, 2, 3))


def gltf(**buffer):
    views = [(0, 48, 5126, 4, "VEC3"), (48, 32, 5126, 4, "VEC2"), (80, 12, 5123, 6, "SCALAR")]
    return json.dumps({
        "asset": {"version": "2.0"}, "scene": 0, "scenes": [{"nodes": [0]}], "nodes": [{"mesh": 0}],
        "meshes": [{"primitives": [{"attributes": {"POSITION": 0, "TEXCOORD_0": 1}, "indices": 2}]}],
        "buffers": [{"byteLength": 92, **buffer}],
        "bufferViews": [{"buffer": 0, "byteOffset": at, "byteLength": size} for at, size, *_ in views],
        "accessors": [{"bufferView": i, "componentType": kind, "count": count, "type": shape}
                      for i, (_, _, kind, count, shape) in enumerate(views)]}).encode()


def glb():
    text = gltf()
    text += b" " * (-len(text) % 4)
    chunks = struct.pack("<I", len(text)) + b"JSON" + text + struct.pack("<I", 92) + b"BIN\0" + gltf_buffer()
    return b"glTF" + struct.pack("<II", 2, 12 + len(chunks)) + chunks


class Files(HardCase):
    def setUp(self):
        super().setUp()
        self.file("quad.obj", QUAD)
        self.oiiotool("--pattern", "checker:color1=.1,.2,.3:color2=2,3,1", "16x8", "3", "-d", "float", "-o", "sky.exr")
        self.oiiotool("sky.exr", "-o", "sky.hdr")
        self.done("makevismap", "quad.obj", "-o", "vm.exr", *SMALL)
        self.done("makecfem", "sky.exr", "-o", "cfem.exr", "--resolution", "8", "--quiet")

    def damages(self, data, seed):
        """Cut at places from the start to the end, and with a bit turned over at others: a few, as whole processes, and
        fewer under sanitizers; many are tried in files_test.cpp."""
        count = 2 if os.environ.get("VMLIGHT_PRELOAD") else 4
        places = random.Random(seed)
        for k in range(count):
            yield f"cut at {len(data) * k // count}", data[:len(data) * k // count]
        for _ in range(count):
            bit = places.randrange(8 * len(data))
            flipped = bytearray(data)
            flipped[bit // 8] ^= 1 << bit % 8
            yield f"bit {bit}", bytes(flipped)

    def survive(self, name, data, words, recipe=None):
        """Each damage ends in a picture of finite pixels, or with one line; in the reader of `recipe` too."""
        made = 0
        for number, (what, damaged) in enumerate(self.damages(data, name)):
            self.file(name, damaged)
            with self.subTest(file=name, damage=what):
                result = self.run_tool(*words, "-o", "x.exr", "--quiet")
                if result.returncode == 0:
                    self.assert_finite("x.exr")
                    os.remove(self.path("x.exr"))
                    made += 1
                else:
                    self.told(result, 1)
                    self.assertFalse(os.path.exists(self.path("x.exr")))
                if recipe and number % 2 == 0:
                    code, _ = self.reader(recipe)
                    if code == 0:
                        self.assert_finite("read.exr")
        self.file(name, data)
        return made

    def test_damaged_meshes(self):
        bake = ["--resolution", "16", "--samples", "4"]
        self.file("m.vismap", 'mesh = "m.glb"\nresolution = 16\nsamples = 4\n')
        self.file("m.gltf", gltf(uri="m.bin"))
        for name, data in (("m.obj", QUAD.encode()), ("text.ply", ply_text()), ("binary.ply", ply_binary()),
                           ("m.glb", glb()), ("m.gltf", gltf(uri="m.bin")), ("m.bin", gltf_buffer())):
            if name != "m.bin":
                self.file("m.bin", gltf_buffer())
            self.file(name, data)
            mesh = "m.gltf" if name == "m.bin" else name
            self.done("makevismap", mesh, "-o", "x.exr", *bake, "--quiet")  # undamaged
            os.remove(self.path("x.exr"))
            self.survive(name, data, ["makevismap", mesh, *bake], "m.vismap" if name == "m.glb" else None)
        self.row("OBJ, PLY, glTF and GLB, cut short or with one bit turned over",
                 "assimp 5.2 ends the process at 39 of 140 damaged binary PLYs", "finite pixels, or exit code 1 and one line")

    def test_damaged_images(self):
        self.file("d.lightmap", 'vismap = "vm.exr"\ncfem = "cfem.exr"\n')
        self.file("d.cfem", 'environment = "sky.hdr"\nresolution = 8\n')
        for name, words, recipe in (("vm.exr", ["makelightmap", "vm.exr", "cfem.exr"], "d.lightmap"),
                                    ("cfem.exr", ["makelightmap", "vm.exr", "cfem.exr"], None),
                                    ("sky.exr", ["makecfem", "sky.exr", "--resolution", "8"], None),
                                    ("sky.hdr", ["makecfem", "sky.hdr", "--resolution", "8"], "d.cfem")):
            self.survive(name, self.read(name), words, recipe)
        self.row("EXR and HDR, cut short or with one bit turned over", "rows that could not be read are black",
                 "finite pixels, or exit code 1 and one line")

    def test_damaged_recipes(self):
        self.file("d.vismap", 'mesh = "quad.obj"\nresolution = [16, 16]\nsamples = 4\nmargin = 2\nnormals = "flat"\n')
        self.file("d.cfem", 'environment = "sky.exr"\nresolution = 8\n')
        self.file("d.lightmap", 'vismap = "d.vismap?resolution=16&samples=1"\ncfem = "d.cfem?resolution=8"\n'
                                'rotate = [0, 30, 0]\n')
        for name, flags in (("d.vismap", ["--resolution", "16"]), ("d.cfem", ["--resolution", "8"]), ("d.lightmap", [])):
            self.survive(name, self.read(name), ["make" + name[2:], name, *flags], name)
        self.row("Recipes, cut short or with one bit turned over", "a key that is none any more is passed over",
                 "the picture of what is left, or exit code 1 and one line")

    def test_display_window_with_one_bit_too_many(self):
        data = bytearray(self.read("sky.exr"))
        at = data.index(b"displayWindow\0box2i\0") + 20 + 4
        self.assertEqual(struct.unpack_from("<4i", data, at), (0, 0, 15, 7))
        struct.pack_into("<i", data, at + 8, 15 | 1 << 28)
        self.file("wide.exr", bytes(data))
        self.told(self.run_tool("makecfem", "wide.exr", "-o", "x.exr", "--resolution", "8"), 1,
                  '"wide.exr": its header says 268435472x8 pixels, of at most 1048576 a side')
        self.file("wide.cfem", 'environment = "wide.exr"\nresolution = 8\n')
        code, told = self.reader("wide.cfem")
        self.assertEqual(code, 1)
        self.assertIn("its header says 268435472x8 pixels", told)
        self.row("One bit of an EXR's display window is wrong: 2^28 columns of black around 16 of light",
                 "all are gone through: 45 s, then out of memory", "exit code 1 at once, with what the header says")

    # What stands in the place of an input; each needs a fresh name.
    def odd(self, kind, name):
        path = self.path(name)
        if kind == "folder":
            os.mkdir(path)
        elif kind == "pipe":
            os.mkfifo(path)
        elif kind == "socket":
            listener = socket.socket(socket.AF_UNIX)
            old = os.getcwd()
            os.chdir(self.folder)  # such names may not be long
            listener.bind(name)
            os.chdir(old)
            self.addCleanup(listener.close)
        elif kind == "empty file":
            self.file(name)
        elif kind == "/dev/null":
            os.symlink("/dev/null", path)
        elif kind == "link to nothing":
            os.symlink("nothing", path)
        elif kind == "link to itself":
            os.symlink(name, path)

    def test_inputs_that_are_no_files(self):
        inputs = [("mesh.obj", ["makevismap", "mesh.obj"]), ("mesh.vismap", ["makevismap", "mesh.vismap"]),
                  ("other.ply", ["makevismap", "quad.obj", "--occluder", "other.ply"]),
                  ("light.exr", ["makecfem", "light.exr"]), ("light.cfem", ["makecfem", "light.cfem"]),
                  ("map.exr", ["makelightmap", "map.exr", "cfem.exr"]),
                  ("light.hdr", ["makelightmap", "vm.exr", "light.hdr"]),
                  ("x.lightmap", ["makelightmap", "x.lightmap"]),
                  ("paint.png", ["makelightmap", "vm.exr", "cfem.exr", "--albedo", "paint.png"]),
                  ("c.ocio", ["makecfem", "sky.exr", "--colorconfig", "c.ocio"]),
                  ("named.mtl", ["makevismap", "material.obj"])]
        self.file("material.obj", "mtllib named.mtl\n" + QUAD)
        self.file("light.toml", "")
        kinds = ["missing", "folder", "pipe", "socket", "empty file", "/dev/null", "link to nothing", "link to itself"]
        for name, words in inputs:
            for kind in kinds if name in ("light.hdr", "mesh.obj") else ["folder", "pipe", "/dev/null"]:
                with self.subTest(name=name, kind=kind):
                    self.odd(kind, name)
                    result = self.run_tool(*words, "-o", "x.exr")
                    if name == "named.mtl":  # colours, which are not needed
                        self.assertEqual(result.returncode, 0, result.stderr)
                        os.remove(self.path("x.exr"))
                    else:
                        self.told(result, 1, name)
                    self.assertFalse(os.path.exists(self.path("x.exr")))
                    if kind == "folder":
                        os.rmdir(self.path(name))
                    elif kind != "missing":
                        os.remove(self.path(name))
        self.row("Each input is missing, a folder, a pipe, a socket, empty, /dev/null, a link to nothing or to itself",
                 "open() of a pipe waits for ever", "exit code 1, one line that names it")

    def test_inputs_that_may_not_be_read(self):
        def become_nobody():
            if os.geteuid() == 0:
                os.setgroups([])
                os.setgid(65534)
                os.setuid(65534)
        os.chmod(self.folder, 0o777)
        shutil.copy(self.path("sky.exr"), self.path("x.exr"))
        for name, words in (("quad.obj", ["makevismap", "quad.obj"]), ("sky.exr", ["makecfem", "sky.exr"]),
                            ("vm.exr", ["makelightmap", "vm.exr", "cfem.exr"])):
            os.chmod(self.path(name), 0)
            self.told(self.run_tool(*words, "-o", "y.exr", preexec_fn=become_nobody), 1, f'"{name}": ')
            os.chmod(self.path(name), 0o644)
        os.chmod(self.path("x.exr"), 0o444)
        before = self.contents()
        self.told(self.run_tool("makecfem", "sky.exr", "-o", "x.exr", preexec_fn=become_nobody), 1,
                  '"x.exr": cannot be written: Permission denied')
        self.assertEqual(self.contents(), before)
        os.chmod(self.folder, 0o555)
        self.told(self.run_tool("makecfem", "sky.exr", "-o", "y.exr", preexec_fn=become_nobody), 1,
                  'the folder "." cannot be written: Permission denied')
        os.chmod(self.folder, 0o755)
        self.assertEqual(self.contents(), before)
        self.row("An input may not be read; the target or its folder may not be written",
                 "a read-only target is replaced, since its folder may be written", "exit code 1, one line, before the work")

    def test_target_is_an_input(self):
        for name, words in (("sky.exr", ["makecfem", "sky.exr", "--resolution", "8"]),
                            ("vm.exr", ["makelightmap", "vm.exr", "cfem.exr"]),
                            ("cfem.exr", ["makelightmap", "vm.exr", "cfem.exr"])):
            data = self.read(name)
            self.done(*words, "-o", "apart.exr")
            self.done(*words, "-o", name)
            self.assertEqual(self.read(name), self.read("apart.exr"))
            self.file(name, data)
        before = self.contents()
        self.told(self.run_tool("makelightmap", "vm.exr", "cfem.exr", "--model", "ao", "-o", "vm.exr"), 1)
        self.assertEqual(self.contents(), before)
        self.row("The target is one of the inputs", "it is emptied before it is read",
                 "the right picture; the old input if the run fails")

    def test_targets_that_are_links(self):
        make = ["makecfem", "sky.exr", "--resolution", "8", "--quiet", "-o"]
        self.done(*make, "new.exr")
        new = self.read("new.exr")
        os.mkdir(self.path("real"))
        self.file("real/old.exr", "old")
        os.chmod(self.path("real/old.exr"), 0o640)
        os.symlink("real/old.exr", self.path("link.exr"))
        os.symlink("real/gone.exr", self.path("dangling.exr"))
        os.link(self.path("real/old.exr"), self.path("twin.exr"))
        for name in "link.exr", "dangling.exr":
            self.done(*make, name)
            self.assertTrue(os.path.islink(self.path(name)))
            self.assertEqual(self.read(name), new)
        self.assertEqual(self.read("twin.exr"), b"old")
        self.assertEqual(os.stat(self.path("real/old.exr")).st_mode & 0o777, 0o640)
        os.symlink("circle.exr", self.path("circle.exr"))
        self.told(self.run_tool(*make, "circle.exr"), 1, '"circle.exr": a link that leads in circles')
        self.assertEqual(sorted(os.listdir(self.path("real"))), ["gone.exr", "old.exr"])
        self.row("The target is a link, a link to nothing, in circles, or a file of two names",
                 "rename() puts a file in the place of the link, readable by all",
                 "what the link leads to is made or replaced, and keeps its rights; the second name keeps the old file")

    def test_names(self):
        self.done("makevismap", "quad.obj", "-o", "plain.exr", *SMALL)
        names = ["with space", " ", "quote'\"", "new\nline", "-o", "--help", "100%", "%s%n%d", "{}", "{0:9999}", "a&b",
                 "tab\t", "\u00fc\u732b\U0001f408", "back\\slash", "*", "$HOME", "#", "####", ";", "<>", "..a", "a" * 251]
        for name in names:
            with self.subTest(name=name):
                mesh, out = name + ".obj", name + ".exr"
                self.file(mesh, QUAD)
                place = "./" if name.startswith("-") else ""
                result = self.run_tool("makevismap", place + mesh, "-o", out, *SMALL)
                self.assertEqual(result.returncode, 0, result.stderr)
                os.remove(self.path(mesh))
                self.done("makelightmap", place + out, "cfem.exr", "--quiet", "-o", "lit.exr")
                os.remove(self.path(out))
        self.file("bytes.obj", QUAD)
        os.rename(self.path("bytes.obj"), os.path.join(self.folder.encode(), b"\xff\xfe.obj"))
        self.assertEqual(self.run_tool("makevismap", b"\xff\xfe.obj", "-o", b"\xfe.exr", *SMALL).returncode, 0)
        self.row("Names with blanks, quotes, a newline, `%s`, `{}`, `*`, a leading `-`, bytes that are no UTF-8, 255 bytes",
                 "a format string, or a hidden part with a name that is too long", "the same picture")

    def test_long_paths(self):
        folder, names = self.folder, []
        while len(folder) + 201 < 3990:
            names.append("d" * 200)
            folder += "/" + names[-1]
        os.makedirs(folder)
        rest = 4090 - len(folder) - len("/.exr")
        for length in rest - 4000 + 3990, rest:
            out = folder + "/" + "f" * min(length, 250) + ".exr"
            shutil.copy(self.path("sky.exr"), folder + "/sky.exr")
            result = self.run_tool("makecfem", folder + "/sky.exr", "-o", out, "--resolution", "8", "--quiet")
            self.assertEqual(result.returncode, 0, result.stderr)
            self.assertEqual(sorted(os.listdir(folder)), sorted(["sky.exr", os.path.basename(out)]))
            os.remove(out)
        self.told(self.run_tool("makecfem", "sky.exr", "-o", "f" * 252 + ".exr"), 1, "File name too long")
        self.told(self.run_tool("makecfem", "sky.exr", "-o", folder + "/" + "f" * 200 + "/x.exr"), 1, "")
        self.row("A path of 4090 bytes; a name of 256", "a hidden part's path is longer than the system takes",
                 "the picture; exit code 1 before the work")

    def test_ten_thousand_files(self):
        os.mkdir(self.path("many"))
        for i in range(10000):
            os.close(os.open(self.path(f"many/sky.{i:05}.exr"), os.O_CREAT | os.O_WRONLY))
        for udim in "1001", "1013":
            shutil.copy(self.path("sky.exr"), self.path(f"many/sky.{udim}.exr"))
        self.done("makecfem", "many/sky.<UDIM>.exr", "-o", "cfem.<UDIM>.exr", "--resolution", "8")
        self.assertEqual([name for name in self.names() if name.startswith("cfem.")],
                         ["cfem.1001.exr", "cfem.1013.exr", "cfem.exr"])
        self.done("makecfem", "sky.exr", "-o", "many/x.exr", "--resolution", "8")
        self.row("Two tiles among 10000 files whose names are almost theirs", "names of five digits are taken for tiles",
                 "the two tiles, well below 10 s")


if __name__ == "__main__":
    unittest.main(argv=[sys.argv[0], *sys.argv[1:]])
