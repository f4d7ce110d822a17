// SPDX-License-Identifier: Apache-2.0
/// Tangents for normal maps, by the convention of MikkTSpace: the same that Blender, Substance, xNormal, Unreal and
/// glTF bake and read normal maps in. Source: M. S. Mikkelsen, "Simulation of Wrinkled Surfaces Revisited", 2008, and
/// the behaviour of his mikktspace.c.
#pragma once

#include <vmlight/mesh/mesh.h>

#include <Imath/ImathVec.h>

#include <array>
#include <vector>

namespace vmlight {

/// Of one corner of a triangle.
struct CornerTangent
{
    /// Along +u, in object space, of unit length, perpendicular to the corner's normal; 0 where directions cancel.
    Imath::V3f tangent { 1, 0, 0 };
    /// The bitangent, along +v (up in the texture), is sign * cross(normal, tangent): -1 where the texture is mirrored.
    float sign = 1;
};

/// Tangents of all corners of `mesh`, which needs uvs. Corners with the same position, normal and uv share a tangent as
/// far as triangles go on from edge to edge with their texture on the same side: the mean of the triangles' directions,
/// weighted by their angles at the corner. Triangles without area, without area in uv or without uvs have the default.
/// Deterministic, on one thread.
std::vector<std::array<CornerTangent, 3>> make_tangents(const Mesh& mesh);

} // namespace vmlight
