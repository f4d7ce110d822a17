# SPDX-License-Identifier: Apache-2.0
"""Packs the add-on, the same bytes on every machine: names in order, no dates, no owners, and nothing compressed, as zlib's
versions differ.

Run as: make_zip.py FOLDER OUTPUT.zip"""
import os
import sys
import zipfile

FIRST_DATE = (1980, 1, 1, 0, 0, 0)
KINDS = (".py", ".toml")


def main():
    folder, output = sys.argv[1:]
    name = os.path.basename(os.path.normpath(folder))
    with zipfile.ZipFile(output, "w", zipfile.ZIP_STORED) as packed:
        for file in sorted(os.listdir(folder)):
            if not file.endswith(KINDS):
                continue
            entry = zipfile.ZipInfo(f"{name}/{file}", FIRST_DATE)
            entry.create_system, entry.external_attr = 3, 0o100644 << 16
            with open(os.path.join(folder, file), "rb") as content:
                packed.writestr(entry, content.read())


if __name__ == "__main__":
    main()
