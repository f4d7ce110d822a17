// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vmlight/mesh/import/ply_header.h>

#include <vector>

namespace vmlight::ply {

/// What a number is, by the name of its property: of a vertex, an index into its eight numbers.
enum Role
{
    kX,
    kY,
    kZ,
    kNormalX,
    kNormalY,
    kNormalZ,
    kU,
    kV,
    kCorners,
    kUvs,
    kTexture,
    kNone
};

/// Of each property.
using Roles = std::vector<Role>;

/// kNone for properties with other names than those that programs give to coordinates, normals, texture coordinates
/// and corners, for lists that should be none and the other way round, and for those of elements other than `vertex`,
/// `face` and `tristrips`.
Roles roles_of(const Element& element);

/// What vertices have besides a position.
struct VertexParts
{
    VertexParts() = default;
    VertexParts(const Element& element, const Roles& roles);

    bool has_doubles = false; ///< a coordinate is of type `double`
    bool has_normals = false, has_uvs = false;
};

bool has_role(const Roles& roles, Role role);

} // namespace vmlight::ply
