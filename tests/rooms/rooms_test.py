# SPDX-License-Identifier: Apache-2.0
"""The plan of the library, lib/vmlight/README.md, against the includes of its files.

Run as: rooms_test.py"""
import os
import re
import unittest

SOURCE = os.path.join(os.path.dirname(os.path.abspath(__file__)), "../..")
LIBRARY = os.path.join(SOURCE, "lib/vmlight")
INCLUDE = re.compile(r'^\s*#\s*include\s*([<"])([^>"]+)[>"]', re.MULTILINE)


def read_plan(text):
    """{room: rooms it may use}, in the order of the table's rows."""
    rows = re.findall(r"^\| `([a-z/]+)` \|[^|]*\|([^|]*)\|$", text, re.MULTILINE)
    return {room: uses.split() for room, uses in rows}


def source_files(folder):
    """Paths relative to `folder` of its C++ files."""
    for place, _, names in os.walk(folder):
        for name in names:
            if name.endswith((".h", ".cpp")):
                yield os.path.relpath(os.path.join(place, name), folder)


def include_faults(plan, path, text):
    """What is wrong with the includes of the library's file `path`."""
    room = os.path.dirname(path)
    for bracket, target in INCLUDE.findall(text):
        if bracket == '"':
            yield f'{path}: "{target}" is relative; write <vmlight/ROOM/NAME.h>'
        elif target.startswith("vmlight/"): # version.h alone is in no room
            used = os.path.dirname(target[len("vmlight/"):])
            if used and used != room and used not in plan.get(room, []):
                yield f"{path}: includes {target}; {room} may use {' '.join(plan.get(room, [])) or 'no other room'}"


class Rooms(unittest.TestCase):
    def setUp(self):
        with open(os.path.join(LIBRARY, "README.md")) as file:
            self.plan = read_plan(file.read())

    def test_includes_run_downward_only(self):
        faults = []
        for path in source_files(LIBRARY):
            with open(os.path.join(LIBRARY, path)) as file:
                faults += include_faults(self.plan, path, file.read())
        self.assertEqual(sorted(faults), [])

    def test_each_folder_is_a_row_and_each_row_a_folder(self):
        self.assertEqual(sorted(self.plan), sorted({os.path.dirname(path) for path in source_files(LIBRARY)}))

    def test_no_row_names_a_room_below_it(self):
        rooms = list(self.plan)
        for at, room in enumerate(rooms):
            self.assertLessEqual(set(self.plan[room]), set(rooms[:at]), room)

    def test_errors_of_openimageio_are_put_on_one_line(self):
        """By oiio::error_line(): OpenImageIO 3 reports some in several."""
        for folder in LIBRARY, os.path.join(SOURCE, "plugins"):
            for path in source_files(folder):
                with open(os.path.join(folder, path)) as file:
                    code = re.sub("//.*", "", file.read())
                if os.path.basename(path) != "oiio_compat.h":
                    self.assertNotIn("geterror()", code, path)

    def test_only_trace_includes_embree(self):
        for path in source_files(LIBRARY):
            with open(os.path.join(LIBRARY, path)) as file:
                targets = [target for _, target in INCLUDE.findall(file.read())]
            if any(target.startswith("embree") for target in targets):
                self.assertEqual(os.path.dirname(path), "trace", path)

    def test_upward_and_sideways_includes_are_found(self):
        for path, text, faults in [("base/params.cpp", "#include <vmlight/math/latlong.h>\n", 1),
                                   ("uv/margin.h", "#include <vmlight/trace/surface.h>\n", 1),
                                   ("uv/margin.h", '#include "margin.h"\n', 1),
                                   ("uv/margin.h", "#  include <vmlight/stage/recipe/recipe.h>\n", 1),
                                   ("nowhere/a.h", "#include <vmlight/base/params.h>\n", 1),
                                   ("uv/margin.h", "#include <vmlight/mesh/mesh.h>\n#include <vector>\n", 0)]:
            self.assertEqual(len(list(include_faults(self.plan, path, text))), faults, (path, text))


if __name__ == "__main__":
    unittest.main()
