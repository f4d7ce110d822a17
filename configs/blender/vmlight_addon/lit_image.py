# SPDX-License-Identifier: Apache-2.0
"""The image in Blender that holds an object's lit texture: floats of the working space."""
import os

import bpy
import numpy

from . import color_spaces


def config_path():
    """Of the OCIO config that Blender uses."""
    shared = os.path.join(bpy.utils.resource_path("LOCAL"), "datafiles")
    if not os.path.isdir(shared):
        shared = os.path.join(bpy.utils.resource_path("SYSTEM"), "datafiles")
    return os.environ.get("OCIO") or os.path.join(shared, "colormanagement", "config.ocio")


def tag(image):
    """Says that an image is of the working space: a packed file is then read as the pixels that were set."""
    for name in color_spaces.scene_linear_names(config_path()):
        try:
            image.colorspace_settings.name = name
            return
        except TypeError:  # this Blender does not call it that
            continue


def show(ob, pixels):
    """Puts pixels (rows from the top, R, G, B) into the object's image, which is made where it is missing."""
    height, width, _ = pixels.shape
    image = ob.vmlight.image
    if image is None or tuple(image.size) != (width, height) or not image.is_float:
        image = _new(ob, width, height)
    whole = numpy.ones((height, width, 4), numpy.float32)
    whole[..., :3] = pixels[::-1]
    image.pixels.foreach_set(whole.ravel())
    image.update()
    image.update_tag()


def _new(ob, width, height):
    image = bpy.data.images.new(f"{ob.name} lit", width, height, alpha=False, float_buffer=True)
    tag(image)
    image.alpha_mode = "NONE"
    old, ob.vmlight.image = ob.vmlight.image, image
    if old:
        name = old.name
        old.user_remap(image)
        bpy.data.images.remove(old)
        image.name = name
    return image


def pack_changed(scenes):
    """Before a .blend is saved: pixels that are not packed are lost."""
    for image in {ob.vmlight.image for scene in scenes for ob in scene.objects if ob.vmlight.image}:
        if image.is_dirty or not image.packed_file:
            image.pack()
