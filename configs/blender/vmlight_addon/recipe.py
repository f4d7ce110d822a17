# SPDX-License-Identifier: Apache-2.0
"""The recipe of an object's lightmap, and the query that relights it."""
import json
import os

from . import tools


def text(vismap, environment, light, folder):
    """A .lightmap in `folder`. Paths below it are relative, so that a project can move.

    @param light: colorspace, "" to leave it out; repair"""
    lines = [f"vismap = {_string(_from(folder, vismap))}", f"environment = {_string(_from(folder, environment))}"]
    if light["colorspace"]:
        lines.append(f"colorspace = {_string(light['colorspace'])}")
    if light["repair"]:
        lines.append("cfem_sanitize = true")
    return "\n".join(lines) + "\n"


def query(path, light):
    """The image's name for OpenImageIO. @param light: rotate, exposure, model"""
    return (f"{path}?rotate={tools.numbers(light['rotate'])}&exposure={light['exposure']:.9g}&model={light['model']}")


def _string(value):
    """TOML's basic strings are JSON's, but for one character that JSON leaves alone."""
    return json.dumps(value, ensure_ascii=False).replace("\x7f", "\\u007f")


def _from(folder, path):
    path = os.path.abspath(path)
    below = os.path.relpath(path, folder) if os.path.splitdrive(path)[0] == os.path.splitdrive(folder)[0] else path
    return path if below.startswith("..") else below.replace(os.sep, "/")
