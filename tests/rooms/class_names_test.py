# SPDX-License-Identifier: Apache-2.0
"""No two files define classes of one full name. They would link without a word, and one would run the other's
constructors and destructors. Names in anonymous namespaces are their file's own.

Run as: class_names_test.py"""
import collections
import os
import re
import unittest

SOURCE = os.path.join(os.path.dirname(os.path.abspath(__file__)), "../..")
# What is linked together.
PROGRAMS = {
    "the library and its tools": ["lib", "plugins"],
    "unit_tests": ["lib", "tests/support", "tests/unit"],
    "hard_tests": ["lib", "tests/support", "tests/hard"],
    "cli_tests": ["lib", "tests/support", "tests/cli"],
    "view_tests": ["lib", "plugins", "tests/support", "tests/view"],
}
NOT_CODE = re.compile(r'//[^\n]*|/\*.*?\*/|R"(\w*)\(.*?\)\1"|"(?:\\.|[^"\\\n])*"|\'(?:\\.|[^\'\\\n])+\'', re.DOTALL)
NAMESPACE = re.compile(r"\bnamespace\b\s*([\w:]*)\s*$")
CLASS = re.compile(r"(?<!enum )\b(?:class|struct|union)\s+(?:alignas\([^)]*\)\s+)?([\w:]+)(?:\s+final)?\s*(?::[^:(][^;]*)?$")
ANONYMOUS, OTHER = object(), object()


def class_names(text):
    """Full names of the classes that a file defines at namespace scope."""
    text = re.sub(r"^\s*#.*(?:\\\n.*)*$", "", NOT_CODE.sub(" ", text), flags=re.MULTILINE)
    scopes, names, before = [], [], ""
    for part in re.split(r"([{};])", text):
        if part == "{":
            space, found = NAMESPACE.search(before), CLASS.search(before)
            is_outside = ANONYMOUS not in scopes and OTHER not in scopes
            if space:
                scopes.append(space.group(1) or ANONYMOUS)
            else:
                # A specialization has arguments after its name, and is another class.
                if found and is_outside:
                    names.append("::".join(scopes + [found.group(1)]))
                scopes.append(OTHER)
        elif part == "}":
            scopes.pop()
        before = "" if part in "{};" else part
    return names


def files_below(folders):
    for folder in folders:
        for path, _, names in os.walk(os.path.join(SOURCE, folder)):
            for name in sorted(names):
                if name.endswith((".h", ".cpp")):
                    yield os.path.relpath(os.path.join(path, name), SOURCE)


def names_of(folders):
    where = collections.defaultdict(set)
    for path in files_below(folders):
        with open(os.path.join(SOURCE, path), encoding="utf-8") as file:
            for name in class_names(file.read()):
                where[name].add(path)
    return where


class ClassNames(unittest.TestCase):
    def test_each_class_is_defined_in_one_file(self):
        for program, folders in PROGRAMS.items():
            where = names_of(folders)
            self.assertGreater(len(where), 100, program)
            for name, paths in where.items():
                with self.subTest(program=program, name=name):
                    self.assertEqual(len(paths), 1, f"{name} is defined in {' and '.join(sorted(paths))}: rename one, "
                                                    "or put it into an anonymous namespace")

    def test_classes_are_found(self):
        text = """// class Comment {};
            namespace a::b { class One { struct Nested {}; }; struct Two final : One { int x { 1 }; };
            namespace { struct Hidden {}; }
            template <class T> class Three { void f() { struct Local {}; } };
            enum class Kind { none }; class Forward; const char* text = "struct Text {";
            struct One::Outside { }; void f(struct Two) { } }
            struct Free { };"""
        self.assertEqual(class_names(text), ["a::b::One", "a::b::Two", "a::b::Three", "a::b::One::Outside", "Free"])


if __name__ == "__main__":
    unittest.main()
