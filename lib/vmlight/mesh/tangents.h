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

/// The axes that a tangent-space normal is relative to, in object space: (x, y, z) stands for x tangent + y bitangent +
/// z normal, normalised.
struct TangentSpace
{
    Imath::V3d tangent, bitangent, normal;

    Imath::V3d to_object(const Imath::V3d& v) const { return tangent * v.x + bitangent * v.y + normal * v.z; }
    /// The inverse of to_object(), up to the length; 0 where the axes are in one plane.
    Imath::V3d from_object(const Imath::V3d& v) const;
};

/// The frame inside a triangle: interpolated without being normalised, and the bitangent made of that, as those who
/// bake and read normal maps do.
/// @param corners  its tangents, from make_tangents()
/// @param weight1, weight2 barycentric weights of its second and third corners
TangentSpace tangent_space(const Mesh& mesh, const std::array<uint32_t, 3>& triangle,
                           const std::array<CornerTangent, 3>& corners, float weight1, float weight2);

} // namespace vmlight
