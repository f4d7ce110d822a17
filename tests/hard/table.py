#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""The table of README.md, from the rows that a run of the tests has written.

  table.py ROWS            fail unless README.md tells of this run
  table.py ROWS --write    write the run's rows into README.md
"""
import json
import os
import sys

README = os.path.join(os.path.dirname(os.path.abspath(__file__)), "README.md")
BEGIN, END = "<!-- table.py writes from here -->\n", "<!-- to here -->\n"
FAMILIES = {"Geometry": "Geometry", "Uv": "Texture coordinates", "Light": "Light", "Arithmetic": "Arithmetic",
            "Files": "Files", "Machine": "Machine"}


def rows_of(folder):
    """{(family, test): row}"""
    found = {}
    for name in os.listdir(folder):
        with open(os.path.join(folder, name)) as data:
            row = json.load(data)
        found[row["family"], row["test"]] = row
    return found


def line_of(row):
    cells = [f"{row['case']} <br> `{row['family']}.{row['test']}`", row["naive"], row["ours"], row["peers"]]
    return "| " + " | ".join(cell.replace("|", "\\|").replace("\n", " ") for cell in cells) + " |\n"


def table_of(rows):
    text = ""
    for family, heading in FAMILIES.items():
        text += f"\n## {heading}\n| case | naive | vmlight | peers |\n|---|---|---|---|\n"
        text += "".join(line_of(rows[key]) for key in sorted(rows) if key[0] == family)
    return text + "\n"


def main():
    rows = rows_of(sys.argv[1])
    skipped = {key: rows.pop(key)["skipped"] for key in list(rows) if "skipped" in rows[key]}
    strangers = {family for family, _ in rows} - set(FAMILIES)
    if strangers:
        sys.exit(f"families that table.py does not know: {', '.join(sorted(strangers))}")
    with open(README) as data:
        text = data.read()
    head, _, rest = text.partition(BEGIN)
    old, _, tail = rest.partition(END)
    table = table_of(rows)
    for (family, test), reason in skipped.items():
        print(f"not run: {family}.{test}: {reason}")
    if "--write" in sys.argv[2:]:
        if skipped:
            sys.exit("the rows of tests that were not run would be lost")
        with open(README, "w") as out:
            out.write(head + BEGIN + table + END + tail)
        print(f"{len(rows)} rows")
    elif old != table:
        names = [f"`{family}.{test}`" for family, test in skipped]
        told = {line for line in old.splitlines() if not any(name in line for name in names)}
        seen = set(table.splitlines())
        if told == seen:
            return
        for line in sorted(told - seen):
            print("- " + line)
        for line in sorted(seen - told):
            print("+ " + line)
        sys.exit("README.md does not tell of this run; tests/hard/table.py ROWS --write does")


main()
