# SPDX-License-Identifier: Apache-2.0
"""A shared libvmlight exports what its public headers declare with VMLIGHT_API, and nothing else of its own.

Run as: exports_test.py LIBRARY HEADER..."""
import re
import subprocess
import sys


def exported(library):
    """Names of vmlight's functions and types that the library shows, without arguments: {"Mesh::name", ...}"""
    listing = subprocess.run(["nm", "-DC", "--defined-only", library], check=True, capture_output=True, text=True).stdout
    names = set()
    for symbol in re.findall(r"^[0-9a-f]+ [TBDRW] (.*)$", listing, re.MULTILINE):
        plain = symbol.replace("[abi:cxx11]", "").split("(")[0]
        while "<" in plain and plain != (plain := re.sub(r"<[^<>]*>", "", plain)):
            pass
        name = re.search(r"\bvmlight::([\w:~]+)$", plain)
        if name:
            names.add(name[1])
    return names


def declared(headers):
    """Names that headers mark as exported; of a class, its name."""
    text = ""
    for header in headers:
        with open(header) as file:
            text += re.sub(r"#define VMLIGHT_API .*", "", file.read())
    return (set(re.findall(r"\bclass VMLIGHT_API (\w+)", text))
            | set(re.findall(r"VMLIGHT_API (?!\w*\s*$)[^;(]*?\b(?!bool\b)(\w+)\(", text)))


def main():
    library, *headers = sys.argv[1:]
    marked, shown = declared(headers), exported(library)
    known = {part for name in shown for part in name.split("::")}
    assert len(marked) > 20, marked
    hidden, stray = sorted(marked - known), sorted(name for name in shown if not marked & set(name.split("::")))
    if hidden:
        print("declared in a public header, but not exported:", *hidden)
    if stray:
        print("exported, but in no public header:", *stray)
    sys.exit(bool(hidden or stray))


main()
