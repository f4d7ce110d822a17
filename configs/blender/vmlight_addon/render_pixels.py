# SPDX-License-Identifier: Apache-2.0
"""The pixels of a lightmap: read from its recipe by OpenImageIO, or made by makelightmap where Blender has no OpenImageIO
that loads vmlight's readers. Neither knows of scenes."""
import os

import bpy
import numpy

from . import job, lit_image, status, tools

NO_READER = "could not find a format reader"

reader_fault = ""  # why OpenImageIO cannot be used; asked once, as the answer does not change
_filtered = {}  # of each environment, what makecfem made: kept for the session


class Failed(Exception):
    """The tools' own words."""


def _openimageio(find):
    """Blender's module, with the readers' folder on its search path; None, with `reader_fault` set, if there is none."""
    global reader_fault
    if reader_fault:
        return None
    try:
        import OpenImageIO
    except ImportError:
        reader_fault = "Blender has no OpenImageIO"
        return None
    folder = tools.readers_folder(find("makelightmap"))
    known = OpenImageIO.get_string_attribute("plugin_searchpath") or ""
    if folder and folder not in known.split(os.pathsep):
        OpenImageIO.attribute("plugin_searchpath", os.pathsep.join(filter(None, (known, folder))))
    return OpenImageIO


def forget():
    """After the preferences changed."""
    global reader_fault
    reader_fault = ""


def pixels(vismap, environment, recipe_path, light, folder, find):
    """Rows from the top, three floats a pixel.

    @param light: rotate, exposure, model, colorspace, repair
    @param folder: for temporary files
    @param find: name of an executable to path
    @raises Failed, tools.Missing
    """
    global reader_fault
    from . import recipe
    module = _openimageio(find)
    if module:
        image = module.ImageInput.open(recipe.query(recipe_path, light))
        if image:
            try:
                result = image.read_image("float")
                if result is None:
                    raise Failed(_short(image.geterror(), recipe_path))
                status.light_note = "by the reader"
                return numpy.asarray(result, numpy.float32).reshape(image.spec().height, image.spec().width, -1)[..., :3]
            finally:
                image.close()
        fault = module.geterror()
        if NO_READER not in fault:
            raise Failed(_short(fault, recipe_path))
        reader_fault = "Blender's OpenImageIO does not load vmlight's readers"
    status.light_note = f"by makelightmap: {reader_fault}"
    return _by_process(vismap, environment, light, folder, find)


def _short(fault, recipe_path):
    """Without the temporary recipe's name, which means nothing to a user, and with the panel's words."""
    for key in "set cfem_sanitize", "set --sanitize":
        fault = fault.replace(key, "turn on Repair Environment")
    head = f'"{recipe_path}'
    return fault.split('": ', 1)[1] if recipe_path and fault.startswith(head) and '": ' in fault else fault


def _by_process(vismap, environment, light, folder, find):
    stamp = (environment, os.stat(environment).st_mtime_ns, light["colorspace"], light["repair"])
    cfem = os.path.join(folder, "environment_cfem.exr")
    if _filtered.get(cfem) != stamp or not os.path.isfile(cfem):
        _run(tools.filter_command(find("makecfem"), environment, cfem, light))
        _filtered[cfem] = stamp
    output = os.path.join(folder, "lit.exr")
    _run(tools.light_command(find("makelightmap"), vismap, cfem, output, light))
    image = bpy.data.images.load(output)
    try:
        lit_image.tag(image)
        width, height = image.size
        values = numpy.empty(width * height * image.channels, numpy.float32)
        image.pixels.foreach_get(values)
        return values.reshape(height, width, -1)[::-1, :, :3]
    finally:
        bpy.data.images.remove(image)
        os.remove(output)


def _run(words):
    done = job.run([job.Step("", words)])
    if done.error:
        raise Failed(_short(done.error, ""))
