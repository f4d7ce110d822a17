# SPDX-License-Identifier: Apache-2.0
"""Brings the atlas of makevismap --unwrap onto a mesh of Blender, whose faces may have more than three corners."""
import bmesh
import numpy

from . import glb, mesh_export

LAYER = "vmlight"

# These put what they add onto the UVs of what they add to.
COPYING_MODIFIERS = ("ARRAY", "BUILD", "MIRROR", "SCREW", "SKIN", "SOLIDIFY")


def part(mesh, name, matrix):
    """The mesh without modifiers, its triangles in Blender's order, for makevismap to unwrap."""
    return mesh_export.part_of_mesh(mesh, name, matrix, by_material=False)


def set_uvs(mesh, atlas):
    """Writes the atlas to the UV map LAYER.

    Where it parts the triangles of one face, whose corners can have one UV only, the face is cut into these triangles.

    @param atlas: path of what makevismap --write-mesh made of part()
    @returns the number of faces that were cut
    @raises mesh_export.Unusable
    """
    corners, _, faces = mesh_export.triangles(mesh)
    uvs = glb.read_uvs(atlas).reshape(-1, 3, 2)
    if len(uvs) != len(corners):
        raise mesh_export.Unusable(f'"{mesh.name}": the atlas has {len(uvs)} triangles, the mesh {len(corners)}: it was '
                                   "changed while it was unwrapped; unwrap again")
    layer = mesh.uv_layers.get(LAYER) or mesh.uv_layers.new(name=LAYER, do_init=False)
    if layer is None:
        raise mesh_export.Unusable(f'"{mesh.name}" has as many UV maps as Blender allows: remove one')
    of_corners = numpy.zeros((len(mesh.loops), 2), numpy.float32)
    of_corners[corners] = uvs
    layer.data.foreach_set("uv", of_corners.ravel())
    parted = numpy.unique(faces[(of_corners[corners] != uvs).any(axis=(1, 2))])
    if len(parted):
        _cut(mesh, parted, corners, faces, uvs)
    mesh.uv_layers[LAYER].active = True
    mesh.update()
    return len(parted)


def _cut(mesh, parted, corners, faces, uvs):
    vertex_of = numpy.empty(len(mesh.loops), numpy.int32)
    mesh.loops.foreach_get("vertex_index", vertex_of)
    edited = bmesh.new()
    edited.from_mesh(mesh)
    edited.verts.ensure_lookup_table()
    edited.faces.ensure_lookup_table()
    layer = edited.loops.layers.uv[LAYER]
    order = numpy.argsort(faces, kind="stable")
    first = numpy.searchsorted(faces[order], parted)
    jobs = []
    for face, start in zip(parted, first):
        count = len(edited.faces[face].verts) - 2
        chosen = order[start:start + count]
        jobs.append((edited.faces[face], vertex_of[corners[chosen]].tolist(), uvs[chosen].tolist()))
    for face, triangles, triangle_uvs in jobs:
        pieces = [face]
        for diagonal in _diagonals(triangles):
            a, b = (edited.verts[vertex] for vertex in diagonal)
            whole = next(piece for piece in pieces if a in piece.verts and b in piece.verts and len(piece.verts) > 3)
            pieces.append(bmesh.utils.face_split(whole, a, b)[0])
        for triangle, its_uvs in zip(triangles, triangle_uvs):
            piece = next(piece for piece in pieces if {vertex.index for vertex in piece.verts} == set(triangle))
            for loop in piece.loops:
                loop[layer].uv = its_uvs[triangle.index(loop.vert.index)]
    edited.to_mesh(mesh)
    edited.free()


def _diagonals(triangles):
    """The edges that two triangles of one face share."""
    seen, shared = set(), []
    for triangle in triangles:
        for i in range(3):
            edge = frozenset((triangle[i], triangle[(i + 1) % 3]))
            if edge in seen:
                shared.append(tuple(edge))
            seen.add(edge)
    return shared
