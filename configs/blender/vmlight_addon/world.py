# SPDX-License-Identifier: Apache-2.0
"""Reads a World: which environment it shows, turned how, and how bright."""
import hashlib
import math
import os
import struct

import bpy

from . import color_spaces, orientation


class Unfollowable(Exception):
    """A World that vmlight cannot light with; the text says why and what to do."""


class Environment:
    """@param path: of a lat-long file. @param colorspace: vmlight's --colorspace
    @param mapping: done to directions, in Blender's axes. @param stops: of its strength"""

    def __init__(self, path, colorspace, mapping=orientation.IDENTITY, stops=0.0):
        self.path, self.colorspace, self.mapping, self.stops = path, colorspace, mapping, stops


def of_file(path, radians):
    """An environment that the user chose, turned as Z of a Mapping node would turn it."""
    if not path:
        raise Unfollowable("no environment: choose a file, or turn on Follow World")
    path = bpy.path.abspath(path)
    if not os.path.isfile(path):
        raise Unfollowable(f'"{path}": no such file')
    return Environment(path, "", orientation.mapping_rotation("POINT", (0, 0, radians)))


def of_world(world, folder):
    """@param folder: for what must be written first: packed images, and worlds of one colour"""
    if world is None:
        raise Unfollowable("the scene has no World: add one with an Environment Texture, or turn off Follow World")
    fault = f'World "{world.name}": '
    if not world.use_nodes:
        return _constant(world.color, 1.0, folder)
    background = _background(world, fault)
    strength = background.inputs["Strength"]
    if strength.is_linked:
        raise Unfollowable(fault + "the Strength of its Background comes from a node: unlink it")
    if strength.default_value < 0:
        raise Unfollowable(fault + f"the Strength of its Background is {strength.default_value:.4g}: it must not be negative")
    source = _source(background.inputs["Color"])
    if source is None:
        return _constant(background.inputs["Color"].default_value, strength.default_value, folder)
    if source.bl_idname != "ShaderNodeTexEnvironment":
        raise Unfollowable(fault + f'the Color of its Background comes from the node "{source.name}": only an Environment '
                           "Texture can be followed")
    if strength.default_value == 0:
        return _constant((0, 0, 0), 0.0, folder)
    if source.projection != "EQUIRECTANGULAR":
        raise Unfollowable(fault + "its Environment Texture is a mirror ball: convert it to equirectangular")
    color = source.color_mapping
    if (color.brightness, color.contrast, color.saturation, color.use_color_ramp) != (1, 1, 1, False):
        raise Unfollowable(fault + "its Environment Texture has a color mapping: reset it")
    path, colorspace = _file(source.image, fault, folder)
    return Environment(path, colorspace, _mapping(source, fault), math.log2(strength.default_value))


def _source(socket):
    """The node that an input comes from, past reroutes; None if it is not linked."""
    while socket.is_linked and socket.links[0].is_valid:
        node = socket.links[0].from_node
        if node.bl_idname != "NodeReroute":
            return node
        socket = node.inputs[0]
    return None


def _background(world, fault):
    output = next((node for node in world.node_tree.nodes
                   if node.bl_idname == "ShaderNodeOutputWorld" and node.is_active_output), None)
    node = _source(output.inputs["Surface"]) if output else None
    # The usual way to show the camera another background: the other side lights.
    if node and node.bl_idname == "ShaderNodeMixShader":
        factor = node.inputs[0]
        chooser = _source(factor)
        if chooser and chooser.bl_idname == "ShaderNodeLightPath" and factor.links[0].from_socket.name == "Is Camera Ray":
            node = _source(node.inputs[1])
    if node is None:
        raise Unfollowable(fault + "nothing is linked to its World Output: link a Background")
    if node.bl_idname != "ShaderNodeBackground":
        raise Unfollowable(fault + f'its Surface comes from the node "{node.name}": only a Background can be followed')
    return node


def texture_of(world):
    """The Environment Texture that lights, and its Mapping node; None for what there is not. For the panel."""
    if world is None or not world.use_nodes:
        return None, None, None
    try:
        background = _background(world, "")
    except Unfollowable:
        return None, None, None
    texture = _source(background.inputs["Color"])
    if texture is None or texture.bl_idname != "ShaderNodeTexEnvironment":
        return background, None, None
    mapping = _source(texture.inputs["Vector"])
    return background, texture, mapping if mapping and mapping.bl_idname == "ShaderNodeMapping" else None


def _mapping(texture, fault):
    """What its own mapping and a Mapping node before it do to directions."""
    own = texture.texture_mapping
    if (own.mapping_x, own.mapping_y, own.mapping_z) != ("X", "Y", "Z") or own.use_min or own.use_max:
        raise Unfollowable(fault + "its Environment Texture swaps or clips axes: reset its texture mapping")
    rotation = _rotation(own.vector_type, own.translation, own.rotation, own.scale, fault)
    lookup = texture.inputs["Vector"]
    node = _source(lookup)
    if node and node.bl_idname == "ShaderNodeMapping":
        values = {}
        for name in ("Location", "Rotation", "Scale"):
            socket = node.inputs.get(name)
            if socket and socket.is_linked:
                raise Unfollowable(fault + f"the {name} of its Mapping node comes from a node: unlink it")
            values[name] = tuple(socket.default_value) if socket else (0, 0, 0)
        turned = _rotation(node.vector_type, values["Location"], values["Rotation"], values["Scale"], fault)
        rotation = orientation.multiply(rotation, turned)
        lookup = node.inputs["Vector"]
        node = _source(lookup)
        if node is None:
            raise Unfollowable(fault + "nothing is linked to the Vector of its Mapping node: link Generated of a Texture "
                               "Coordinate")
    if node is None:
        return rotation
    while lookup.links[0].from_node.bl_idname == "NodeReroute":
        lookup = lookup.links[0].from_node.inputs[0]
    output = lookup.links[0].from_socket.name
    if node.bl_idname != "ShaderNodeTexCoord" or not (output == "Generated" or (output == "Object" and not node.object)):
        raise Unfollowable(fault + f'its map is looked up by the node "{node.name}": only Generated of a Texture Coordinate, '
                           "with at most one Mapping, can be followed")
    return rotation


def _rotation(kind, location, radians, scale, fault):
    wrong = orientation.mapping_fault(kind, location, scale)
    if wrong:
        raise Unfollowable(fault + wrong)
    return orientation.mapping_rotation(kind, radians)


def _file(image, fault, folder):
    """(path, --colorspace) of the image."""
    if image is None:
        raise Unfollowable(fault + "its Environment Texture has no image: open one")
    if image.source != "FILE":
        raise Unfollowable(fault + f'its image "{image.name}" is no single file: save it as one')
    colorspace, wrong = color_spaces.vmlight_name(image.colorspace_settings.name, bool(os.environ.get("OCIO")))
    if wrong:
        raise Unfollowable(f'image "{image.name}": {wrong}')
    path = bpy.path.abspath(image.filepath, library=image.library)
    if image.packed_file:
        data = bytes(image.packed_file.data)
        extension = os.path.splitext(path)[1] or ".exr"
        packed = os.path.join(folder, f"packed_{hashlib.sha256(data).hexdigest()[:16]}{extension}")
        if not os.path.isfile(packed):
            os.makedirs(folder, exist_ok=True)
            with open(packed, "wb") as file:
                file.write(data)
        return packed, colorspace
    if not os.path.isfile(path):
        raise Unfollowable(f'image "{image.name}": "{path}": no such file')
    return path, colorspace


def _constant(color, strength, folder):
    """A World without a texture: a map of one colour, exact in 32 bits."""
    rgb = [max(float(channel) * strength, 0.0) for channel in tuple(color)[:3]]
    name = "constant_" + "_".join(f"{channel:.9g}" for channel in rgb) + ".exr"
    path = os.path.join(folder, name)
    if not os.path.isfile(path):
        os.makedirs(folder, exist_ok=True)
        write_exr(path, 4, 2, rgb)
    return Environment(path, "")


def write_exr(path, width, height, rgb):
    """An uncompressed OpenEXR file of one colour, in the working space."""
    def attribute(name, kind, data):
        return name + b"\0" + kind + b"\0" + struct.pack("<i", len(data)) + data

    box = struct.pack("<4i", 0, 0, width - 1, height - 1)
    channels = b"".join(name + b"\0" + struct.pack("<iB3xii", 2, 0, 1, 1) for name in (b"B", b"G", b"R")) + b"\0"
    header = b"v/1\x01" + struct.pack("<i", 2)
    header += attribute(b"channels", b"chlist", channels) + attribute(b"compression", b"compression", b"\0")
    header += attribute(b"dataWindow", b"box2i", box) + attribute(b"displayWindow", b"box2i", box)
    header += attribute(b"lineOrder", b"lineOrder", b"\0") + attribute(b"pixelAspectRatio", b"float", struct.pack("<f", 1))
    header += attribute(b"screenWindowCenter", b"v2f", struct.pack("<2f", 0, 0))
    header += attribute(b"screenWindowWidth", b"float", struct.pack("<f", 1)) + b"\0"
    row = b"".join(struct.pack(f"<{width}f", *[value] * width) for value in (rgb[2], rgb[1], rgb[0]))
    first, size = len(header) + 8 * height, 8 + len(row)
    temporary = path + ".part"
    with open(temporary, "wb") as file:
        file.write(header + b"".join(struct.pack("<Q", first + y * size) for y in range(height)))
        for y in range(height):
            file.write(struct.pack("<ii", y, len(row)) + row)
    os.replace(temporary, path)
