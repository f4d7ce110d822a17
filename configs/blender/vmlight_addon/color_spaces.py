# SPDX-License-Identifier: Apache-2.0
"""Colour spaces: what Blender calls them, and what vmlight calls them.

The two agree on the working space: the role scene_linear of $OCIO, or linear Rec.709 where $OCIO is not set (Blender then
has a config of its own, whose name for it changed with version 4.0).
"""
import os
import re

# Blender's own config: 3.x, then 4.x, then 5.x where it differs.
OURS = {
    "Linear": "lin_rec709_scene",
    "Linear Rec.709": "lin_rec709_scene",
    "sRGB": "srgb_rec709_scene",
    "Linear ACEScg": "lin_ap1_scene",
    "ACEScg": "lin_ap1_scene",
    "Linear ACES": "lin_ap0_scene",
    "ACES2065-1": "lin_ap0_scene",
    "Linear Rec.2020": "lin_rec2020_scene",
}
# Pixels that are taken as they are: of the working space.
PLAIN = ("Non-Color", "Raw", "Generic Data")
SCENE_LINEAR = ("Linear", "Linear Rec.709", "scene_linear", "Non-Color")


def scene_linear_names(config_path=""):
    """What Blender's working space may be called, the likeliest first.

    @param config_path: the OCIO config that Blender uses, where it can be read
    """
    names = list(SCENE_LINEAR)
    if config_path and os.path.isfile(config_path):
        with open(config_path, encoding="utf-8", errors="replace") as file:
            role = re.search(r"^\s+scene_linear:\s*(.+?)\s*$", file.read(), re.MULTILINE)
        if role:
            names.insert(0, role.group(1).strip("\"'"))
    return names


def vmlight_name(blender_name, has_ocio):
    """The value of --colorspace for a file that Blender takes as `blender_name`.

    @param has_ocio: whether $OCIO is set: then the names are that config's, and vmlight knows them too
    @returns (name, fault): one of both is ""
    """
    if blender_name in PLAIN:
        return "scene_linear" if has_ocio else "lin_rec709_scene", ""
    if has_ocio:
        return blender_name, ""
    if blender_name in OURS:
        return OURS[blender_name], ""
    return "", (f'colour space "{blender_name}" is unknown to vmlight: choose {", ".join(list(OURS)[:4])}, '
                "or set $OCIO for Blender")
