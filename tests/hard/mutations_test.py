# SPDX-License-Identifier: Apache-2.0
"""Each patch of mutations/ names its tests, and what it takes out is still there once. (That the tests then fail is for
mutate.sh to show, which takes many builds.)

Run as: mutations_test.py"""
import glob
import os
import re
import sys
import unittest

HERE = os.path.dirname(os.path.abspath(__file__))
SOURCE = os.path.join(HERE, "../..")


def hunks(patch):
    """Pairs of a file and the lines that a hunk finds in it."""
    name, lines = None, []
    for line in patch.splitlines() + ["@@"]:
        if line.startswith(("---", "+++", "@@")):
            if lines:
                yield name, "".join(lines)
            lines = []
            if line.startswith("--- a/"):
                name = line[6:].split("\t")[0]
        elif name and line[:1] in ("-", " "):
            lines.append(line[1:] + "\n")


class Mutations(unittest.TestCase):
    def test_each_applies_and_names_tests_that_are_there(self):
        patches = glob.glob(os.path.join(HERE, "mutations/*.patch"))
        self.assertGreaterEqual(len(patches), 10)
        with open(os.path.join(HERE, "README.md")) as file:
            known = set(re.findall(r"<br> `([A-Za-z.]+)` \|", file.read()))
        families = {name.split(".")[0] for name in known}
        for path in patches:
            with self.subTest(patch=os.path.basename(path)), open(path) as file:
                patch = file.read()
                tests = set(re.match(r"Test: *(.*)\n", patch).group(1).split())
                self.assertTrue(tests and tests <= known | families, tests)
                found = list(hunks(patch))
                self.assertTrue(found)
                for name, text in found:
                    with open(os.path.join(SOURCE, name)) as source:
                        self.assertEqual(source.read().count(text), 1, (name, text))


if __name__ == "__main__":
    unittest.main(argv=[sys.argv[0], *sys.argv[1:]])
