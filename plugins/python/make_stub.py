# SPDX-License-Identifier: Apache-2.0
"""Write the type stub of the module, from the table that its functions and their docstrings are made of.

Run as: make_stub.py TEMPLATE STUB, with the built package on sys.path"""
import os
import re
import sys


def definition(name, function, indent=""):
    """The `def` of an entry of the table; `name` as in Class.method."""
    short = name.split(".")[-1]
    is_static = "." in name and short == "read"
    parts = ["self"] if "." in name and not is_static else []
    parts += [f"{operand}: {hint}" + (f" = {value}" if value else "") for operand, hint, value in function["operands"]]
    parts += ["*"] if function["keywords"] else []
    parts += [f"{keyword}: {hint} = {value}" for keyword, hint, value in function["keywords"]]
    parts = [re.sub(r"\b(StrPath|Floats)\b", r"_\1", part) for part in parts]  # not there at run time
    lines = [indent + "@staticmethod"] if is_static else []
    lines += [f"{indent}def {short}("] + [f"{indent}    {part}," for part in parts]
    return "\n".join(lines + [f"{indent}) -> {function['returns'] or 'None'}: ..."])


def stub(template, functions):
    """The template with each line "# NAME" of a function replaced by its definition."""
    def fill(match):
        return definition(match[2], functions.pop(match[2]), match[1])

    functions = dict(functions)
    text = re.sub(r"^( *)# (%s)$" % "|".join(map(re.escape, functions)), fill, template, flags=re.MULTILINE)
    if functions:
        sys.exit(f"make_stub.py: the template has no line for {', '.join(functions)}")
    return text


def main():
    template, output = sys.argv[1:]
    from vmlight import _vmlight
    with open(template, encoding="utf-8") as file:
        text = stub(file.read(), _vmlight._functions())
    with open(output + ".new", "w", encoding="utf-8") as file:
        file.write(text)
    os.replace(output + ".new", output)


if __name__ == "__main__":
    main()
