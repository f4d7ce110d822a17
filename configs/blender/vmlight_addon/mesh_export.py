# SPDX-License-Identifier: Apache-2.0
"""Objects of a scene as glTF parts: with their modifiers, in the place that they have."""
import numpy

from . import glb

GEOMETRY = ("MESH", "CURVE", "SURFACE", "FONT", "META", "CURVES")


class Unusable(Exception):
    """An object that cannot be baked; the text says why and what to do."""


def _array(collection, attribute, columns, kind):
    values = numpy.empty(len(collection) * columns, kind)
    collection.foreach_get(attribute, values)
    return values.reshape(-1, columns) if columns > 1 else values


def loop_normals(mesh):
    """Smooth, flat and custom normals, a row a face corner. Blender 4.1 computes them on its own."""
    if hasattr(mesh, "corner_normals"):
        return _array(mesh.corner_normals, "vector", 3, numpy.float32)
    mesh.calc_normals_split()
    return _array(mesh.loops, "normal", 3, numpy.float32)


def triangles(mesh):
    """(face corners of each triangle, its material's slot, its face), in Blender's own order."""
    mesh.calc_loop_triangles()
    return (_array(mesh.loop_triangles, "loops", 3, numpy.int32),
            _array(mesh.loop_triangles, "material_index", 1, numpy.int32),
            _array(mesh.loop_triangles, "polygon_index", 1, numpy.int32))


def part_of_mesh(mesh, name, matrix, uv_map="", by_material=True):
    """A part whose vertices are the mesh's face corners; None if it has no face.

    @param uv_map: the UV map to write; "" for none
    @param by_material: False leaves the triangles in Blender's order
    """
    corners, slots, _ = triangles(mesh)
    if not len(corners):
        return None
    vertices = _array(mesh.loops, "vertex_index", 1, numpy.int32)
    positions = _array(mesh.vertices, "co", 3, numpy.float32)[vertices]
    uvs = None
    if uv_map:
        layer = mesh.uv_layers.get(uv_map)
        if layer is None:
            raise Unusable(f'"{name}": its modifiers leave no UV map "{uv_map}": apply them, or unwrap what they make')
        uvs = _array(layer.data, "uv", 2, numpy.float32)
    groups = [("", corners)]
    if by_material and len(mesh.materials):
        names = [material.name if material else "" for material in mesh.materials]
        slots = numpy.clip(slots, 0, len(names) - 1)
        groups = [(names[slot], corners[slots == slot]) for slot in numpy.unique(slots)]
    columns = [matrix[row][column] for column in range(4) for row in range(4)]
    return glb.Part(name, columns, positions, loop_normals(mesh), uvs, groups)


def part_of_object(evaluated, name, matrix, uv_map=""):
    """@param evaluated: by a depsgraph. None if there is no face to see"""
    try:
        mesh = evaluated.to_mesh()
    except RuntimeError:
        return None
    if mesh is None:
        return None
    try:
        return part_of_mesh(mesh, name, matrix, uv_map)
    finally:
        evaluated.to_mesh_clear()


def unique_name(name, taken):
    """Objects of linked libraries may share a name; a node's name chooses all of that name."""
    result, number = name, 1
    while result in taken:
        number += 1
        result = f"{name} #{number}"
    taken.add(result)
    return result


def blocks_light(original):
    """Whether an object that is seen in the viewport also blocks light in a render."""
    return (original.type in GEOMETRY and not original.hide_render and getattr(original, "visible_shadow", True))


def scene_parts(depsgraph, baked, uv_maps, all_visible):
    """The parts of the objects to bake, in their order, and then of what else blocks light.

    @param baked: original objects
    @param uv_maps: of each, the UV map to bake in
    @param all_visible: whether everything visible blocks light, instances too, or the baked objects alone
    @returns (parts, names of the baked objects' nodes)
    """
    parts, names, taken = [], [], {"Blender"}
    for original, uv_map in zip(baked, uv_maps):
        evaluated = original.evaluated_get(depsgraph)
        name = unique_name(original.name, taken)
        part = part_of_object(evaluated, name, evaluated.matrix_world, uv_map)
        if part is None:
            raise Unusable(f'"{original.name}" has no faces, so nothing to bake')
        parts.append(part)
        names.append(name)
    if all_visible:
        for instance in depsgraph.object_instances:
            original = instance.object.original
            if not blocks_light(original) or (not instance.is_instance and original in baked):
                continue
            if not instance.is_instance and not instance.show_self:
                continue
            part = part_of_object(instance.object, unique_name(original.name, taken), instance.matrix_world)
            if part:
                parts.append(part)
    return parts, names


def kept_uv_map(mesh):
    """The name of the UV map that renders use; "" if there is none."""
    return next((layer.name for layer in mesh.uv_layers if layer.active_render), "")


def base_colors(objects):
    """Of the objects' materials, by name. What nodes make of textures is left out: their color stays white."""
    colors = {}
    for material in (slot.material for ob in objects for slot in ob.material_slots if slot.material):
        shader = None
        if material.use_nodes:
            shader = next((node for node in material.node_tree.nodes if node.bl_idname == "ShaderNodeBsdfPrincipled"), None)
        else:
            colors[material.name] = tuple(material.diffuse_color)
        if shader and not shader.inputs["Base Color"].is_linked:
            colors[material.name] = tuple(shader.inputs["Base Color"].default_value)
    return {name: tuple(min(max(x, 0), 1) for x in color) for name, color in colors.items()}
