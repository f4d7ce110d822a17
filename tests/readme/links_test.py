# SPDX-License-Identifier: Apache-2.0
"""README.md stays short; every relative link of the documentation leads to a file, and to a heading where it names one; and
the functions that docs/ names exist.

Run as: links_test.py"""
import glob
import os
import re
import unittest

SOURCE = os.path.join(os.path.dirname(os.path.abspath(__file__)), "../..")
README_LINES = 150
PAGES = ["README.md", "CONTRIBUTING.md", "CHANGELOG.md", "lib/vmlight/README.md", "tests/data/README.md",
         "tests/hard/README.md"]
LINK = re.compile(r"\]\(([^()\s]+)\)")


def read(path):
    with open(path) as file:
        return file.read()


def without_code(text):
    """Indented and fenced blocks and `code` hold no links."""
    text = re.sub(r"^```.*?^```", "", text, flags=re.MULTILINE | re.DOTALL)
    return re.sub(r"`[^`\n]*`", "code", re.sub(r"^    .*", "", text, flags=re.MULTILINE))


def anchors(text):
    """Of the headings, as GitHub makes them."""
    headings = re.findall(r"^#+ (.*)", text, re.MULTILINE)
    return [re.sub(r"[^\w\- ]", "", heading.lower()).replace(" ", "-") for heading in headings]


def link_faults(page, text):
    """What is wrong with the links of a page in folder SOURCE."""
    for link in LINK.findall(without_code(text)):
        if re.match(r"[a-z]+:", link):
            continue
        path, _, anchor = link.partition("#")
        target = os.path.normpath(os.path.join(SOURCE, os.path.dirname(page), path)) if path else os.path.join(SOURCE, page)
        if not os.path.exists(target):
            yield f"{page}: {link}: no such file"
        elif anchor and anchor not in anchors(read(target)):
            yield f"{page}: {link}: no such heading"


def sources():
    """All code of the library and the plugins."""
    paths = [path for folder in ("lib", "plugins") for path in glob.glob(os.path.join(SOURCE, folder, "**/*"), recursive=True)]
    return "\n".join(read(path) for path in paths if path.endswith((".h", ".cpp", ".in")))


def function_faults(page, text, code):
    """The functions of a page, such as `make_cfem()` or `Mesh::size()`, that are not in `code`."""
    for name in re.findall(r"`([\w:]+)\(\)`", text):
        if not all(re.search(rf"\b{part}\b", code) for part in name.split("::")):
            yield f"{page}: {name}(): no such function"


class Links(unittest.TestCase):
    def test_readme_is_short(self):
        self.assertLess(read(os.path.join(SOURCE, "README.md")).count("\n"), README_LINES)

    def test_links_lead_somewhere(self):
        pages = PAGES + [os.path.relpath(path, SOURCE) for path in sorted(glob.glob(os.path.join(SOURCE, "docs/*.md")))]
        self.assertGreater(len(pages), len(PAGES) + 4)
        faults = [fault for page in pages for fault in link_faults(page, read(os.path.join(SOURCE, page)))]
        self.assertEqual(faults, [])

    def test_functions_exist(self):
        code = sources()
        faults = []
        for path in sorted(glob.glob(os.path.join(SOURCE, "docs/*.md"))):
            faults += function_faults(os.path.relpath(path, SOURCE), read(path), code)
        self.assertEqual(faults, [])

    def test_the_test_itself_finds_broken_links(self):
        text = ("## Quick start, now\n[a](README.md) [b](absent.md) `[c](code.md)` [d](#quick-start-now) [e](#absent)\n"
                "    [f](indented.md)\n[g](https://example.com/x) ![h](docs/absent.png)\n")
        self.assertEqual(anchors(text), ["quick-start-now"])
        self.assertEqual(list(link_faults("README.md", text)),
                         ["README.md: absent.md: no such file", "README.md: #quick-start-now: no such heading",
                          "README.md: #absent: no such heading", "README.md: docs/absent.png: no such file"])
        self.assertEqual(list(function_faults("a.md", "`size()` `Mesh::area()` `Mesh`", "class Mesh { int size() };")),
                         ["a.md: Mesh::area(): no such function"])


if __name__ == "__main__":
    unittest.main()
