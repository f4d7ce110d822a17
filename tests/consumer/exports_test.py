# SPDX-License-Identifier: Apache-2.0
"""A shared libvmlight exports what its public headers declare with VMLIGHT_API, and nothing else of its own.

Run as: exports_test.py LIBRARY LIB_FOLDER HEADER..."""
import re
import subprocess
import sys


def exported(library):
    """Names of vmlight's functions that the library shows, without arguments."""
    listing = subprocess.run(["nm", "-DC", "--defined-only", library], check=True, capture_output=True, text=True).stdout
    names = re.findall(r"^[0-9a-f]+ [TWBDVR] (?:.* )?(vmlight::[\w:~]+)", listing, re.MULTILINE)
    return {name.removeprefix("vmlight::") for name in names}


def declared(folder, headers):
    """Names that headers mark as exported; of a class, its name."""
    text = ""
    for header in headers:
        with open(f"{folder}/{header}") as file:
            text += file.read()
    return (set(re.findall(r"\bclass VMLIGHT_API (\w+)", text))
            | set(re.findall(r"VMLIGHT_API (?!\w*\s*$)[^;(]*?\b(\w+)\(", text)))


def main():
    library, folder, *headers = sys.argv[1:]
    marked, shown = declared(folder, headers), exported(library)
    known = {name.split("::")[0] for name in shown}
    assert len(marked) > 20, marked
    hidden, stray = sorted(marked - known), sorted(name for name in shown if name.split("::")[0] not in marked)
    if hidden:
        print("declared in a public header, but not exported:", *hidden)
    if stray:
        print("exported, but in no public header:", *stray)
    sys.exit(bool(hidden or stray))


main()
