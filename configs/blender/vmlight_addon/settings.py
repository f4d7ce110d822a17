# SPDX-License-Identifier: Apache-2.0
"""What the panel sets, and what an object remembers of its map. All is saved in the .blend."""
import math

import bpy
from bpy.props import (BoolProperty, CollectionProperty, EnumProperty, FloatProperty, FloatVectorProperty, IntProperty,
                       PointerProperty, StringProperty)

from . import light


def _relight(_settings, _context):
    light.schedule()


class VmlightSlot(bpy.types.PropertyGroup):
    """A material slot before Apply."""
    link: StringProperty()
    material: PointerProperty(type=bpy.types.Material)


class VmlightObject(bpy.types.PropertyGroup):
    vismap: StringProperty(name="Visibility map", subtype="FILE_PATH")
    uv_map: StringProperty(name="UV map", description="The UV map that the map was baked in")
    turn: FloatVectorProperty(size=4, default=(1, 0, 0, 0), description="The object's rotation when it was baked: w, x, y, z")
    image: PointerProperty(type=bpy.types.Image, description="The lit texture")
    lit_as: StringProperty(description="What the lit texture was made of")
    slots: CollectionProperty(type=VmlightSlot)
    added_slot: BoolProperty()
    applied: BoolProperty()


class VmlightScene(bpy.types.PropertyGroup):
    uv_source: EnumProperty(
        name="UVs", default="KEEP",
        items=(("KEEP", "Keep", "Bake in the UV map that renders use: it must not overlap"),
               ("UNWRAPPED", "Unwrapped", 'Bake in the UV map "vmlight", which Unwrap makes')))
    resolution: IntProperty(name="Resolution", default=1024, min=16, max=32768, description="Width and height in texels")
    samples: IntProperty(name="Samples", default=64, min=1, max=1 << 20, description="Rays per texel")
    margin: IntProperty(name="Margin", default=16, min=0, max=1024, description="Dilation around UV islands, in texels")
    basis: EnumProperty(
        name="Basis", default="vector", description="What to store: more is more accurate behind occluders",
        items=(("vector", "Vector", "Visibility and mean direction: four floats a texel"),
               ("sh", "Harmonics", "Spherical harmonics of five bands: 25 floats a texel"),
               ("cells", "Cells", "How much of each of 144 cells of the sphere is visible")))
    max_distance: FloatProperty(name="Max Distance", default=0, min=0, subtype="DISTANCE",
                                description="Nothing farther away blocks light; 0: no limit")
    occluders: EnumProperty(
        name="Occluders", default="VISIBLE",
        items=(("SELECTED", "Selected", "The selected objects block each other's light, and their own"),
               ("VISIBLE", "All Visible", "Everything that is visible in the viewport and in renders blocks light")))
    folder: StringProperty(name="Folder", default="//vmlight", subtype="DIR_PATH",
                           description="Where visibility maps are kept; of an unsaved .blend, until Blender quits")
    follow_world: BoolProperty(name="Follow World", default=True, update=_relight,
                               description="Light with the World's environment texture, its mapping and its strength")
    environment: StringProperty(name="Environment", subtype="FILE_PATH", update=_relight, description="Lat-long environment")
    rotation: FloatProperty(name="Rotation", subtype="ANGLE", soft_min=-math.pi, soft_max=math.pi, update=_relight,
                            description="Turns the environment about the vertical, as Z of a Mapping node in the World does")
    exposure: FloatProperty(name="Exposure", default=0, min=-64, max=64, soft_min=-8, soft_max=8, update=_relight,
                            description="In stops; on top of the World's strength")
    model: EnumProperty(
        name="Model", default="auto", update=_relight,
        items=(("auto", "Best", "The most accurate model that the map and the light allow"),
               ("ao", "Ambient Occlusion", "Visibility times the light around the normal"),
               ("paper", "Paper", "Visibility times the light around the mean visible direction"),
               ("lobe", "Lobe", "Like Paper, with a lobe as wide as the visible part of the sky")))
    repair: BoolProperty(name="Repair Environment", default=False, update=_relight,
                         description="Repair NaN, infinite and negative pixels of the environment")
    use_base_color: BoolProperty(name="Base Color", default=True,
                                 description="Multiply the light by each material's base color")
    turntable: StringProperty(name="Output", default="//turntable.####.png", subtype="FILE_PATH",
                              description="Pictures of the turntable; #### is the frame")


CLASSES = (VmlightSlot, VmlightObject, VmlightScene)


def register():
    for cls in CLASSES:
        bpy.utils.register_class(cls)
    bpy.types.Object.vmlight = PointerProperty(type=VmlightObject)
    bpy.types.Scene.vmlight = PointerProperty(type=VmlightScene)


def unregister():
    del bpy.types.Scene.vmlight
    del bpy.types.Object.vmlight
    for cls in reversed(CLASSES):
        bpy.utils.unregister_class(cls)
