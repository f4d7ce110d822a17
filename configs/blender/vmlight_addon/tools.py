# SPDX-License-Identifier: Apache-2.0
"""Where vmlight's executables and readers are, and how they are called."""
import glob
import os
import re
import shutil

from . import orientation

EXECUTABLES = ("makevismap", "makecfem", "makelightmap", "vmframes")
SUFFIX = ".exe" if os.name == "nt" else ""
READER = "lightmap.imageio"


class Missing(Exception):
    """An executable that is not found; the text says what to do."""


def _runnable(folder, name):
    path = os.path.join(folder, name + SUFFIX)
    return path if os.path.isfile(path) and os.access(path, os.X_OK) else ""


def find(name, preferred="", search_path=None, beside=None):
    """The path of an executable: in the preferences' folder, in $PATH, or next to the add-on, in that order. A folder in
    the preferences is the only place to look, so that no other version runs unseen.

    @param preferred: that folder, or its parent
    @param search_path: for tests: instead of $PATH
    @param beside: for tests: instead of the add-on's folder
    @raises Missing
    """
    if preferred:
        path = _runnable(preferred, name) or _runnable(os.path.join(preferred, "bin"), name)
        if not path:
            raise Missing(f'{name} is not in "{preferred}", the folder in the add-on\'s preferences: correct it, or clear it '
                          "to search $PATH")
        return path
    path = shutil.which(name, path=search_path)
    beside = beside or os.path.dirname(os.path.abspath(__file__))
    path = path or _runnable(beside, name) or _runnable(os.path.join(beside, "bin"), name)
    if not path:
        raise Missing(f"{name} is not installed: install vmlight, and set its folder in the add-on's preferences, or add it "
                      "to $PATH")
    return os.path.abspath(path)


def readers_folder(executable):
    """Where the readers that belong to an executable are; "" if they are not found."""
    folder = os.path.dirname(os.path.realpath(executable))
    places = ("../plugins", "../lib/vmlight", "../lib64/vmlight", "../lib/*/vmlight", "vmlight", ".")
    for place in places:
        for found in sorted(glob.glob(os.path.join(glob.escape(folder), place, READER + ".*"))):
            return os.path.normpath(os.path.dirname(found))
    return ""


def file_name(name):
    """A name as part of a file's name, as makevismap's <MATERIAL> does it: no separator, no query, no pattern."""
    clean = re.sub(r"[\x00-\x7f]", lambda c: c.group() if re.match(r"[\w.-]", c.group()) else "_", name)
    return re.sub(r"^\.", "_", clean) or "_"


def unused_name(name, ending, taken):
    """A file for `name` that is not in `taken`, to which it is added: "a/b" and "a?b" would share one."""
    base, number = file_name(name), 1
    result = base + ending
    while result in taken:
        number += 1
        result = f"{base}_{number}{ending}"
    taken.add(result)
    return result


def bake_command(makevismap, mesh, node, output, options):
    """@param options: resolution, samples, margin, basis; max_distance, 0 for infinite"""
    words = [makevismap, mesh, "--node", node, "-o", output, "--resolution", str(options["resolution"]), "--samples",
             str(options["samples"]), "--margin", str(options["margin"]), "--basis", options["basis"],
             "--channels", "normal,coverage"]
    if options.get("max_distance", 0) > 0:
        words += ["--max-distance", f"{options['max_distance']:.9g}"]
    return words


def unwrap_command(makevismap, mesh, output, mesh_output, options):
    """The map is of no use: one ray a texel is the least."""
    return [makevismap, mesh, "--unwrap", "--write-mesh", mesh_output, "-o", output, "--resolution",
            str(options["resolution"]), "--margin", str(options["margin"]), "--samples", "1"]


def filter_command(makecfem, environment, output, light):
    """All that any model reads, once for all rotations. @param light: colorspace, repair"""
    words = [makecfem, environment, "--stack", "-o", output, "--quiet"]
    return words + (["--colorspace", light["colorspace"]] if light["colorspace"] else []) + (
        ["--sanitize"] if light["repair"] else [])


def light_command(makelightmap, vismap, cfem, output, light):
    """@param light: rotate, exposure, model"""
    return [makelightmap, vismap, cfem, "-o", output, "--rotate", numbers(light["rotate"]), "--exposure",
            f"{light['exposure']:.9g}", "--model", light["model"], "--quiet"]


def frames_command(vmframes, meshes, environment, output, light, frames, vismap, options):
    """@param meshes: a file an object
    @param frames: (first, last)
    @param vismap: of the only mesh; "" to bake"""
    # The sky is turned, not the objects before the camera.
    sky = orientation.inverse_angles(light["rotate"])
    words = [vmframes, meshes[0], environment, "-o", output, "--frames", f"{frames[0]}-{frames[1]}", "--turntable",
             "--env-rotate", numbers(sky), "--exposure", f"{light['exposure']:.9g}"]
    for mesh in meshes[1:]:
        words += ["--object", mesh]
    if vismap:
        words += ["--vismap", vismap]
    else:
        words += ["--resolution", str(options["resolution"]), "--samples", str(options["samples"])]
    return words + environment_flags(light)


def environment_flags(light):
    """Of tools that filter an environment themselves. @param light: colorspace, repair"""
    return (["--colorspace", light["colorspace"]] if light["colorspace"] else []) + (
        ["--cfem-sanitize"] if light["repair"] else [])


def numbers(values):
    return ",".join(f"{value:.12g}" for value in values)
