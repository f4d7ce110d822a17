// SPDX-License-Identifier: Apache-2.0
/// What every mesh that was read keeps.
#pragma once

#include "law.h"

#include <vmlight/base/format.h>
#include <vmlight/mesh/mesh.h>

#include <cmath>
#include <string>

namespace vmlight::fuzz {

inline std::string said(const Imath::V3d& v)
{
    return format("({}, {}, {})", v.x, v.y, v.z);
}

inline void require_whole(const Mesh& mesh)
{
    const size_t triangles = mesh.triangles.size();
    require(triangles > 0 && mesh.normals.size() == mesh.positions.size() && mesh.triangle_materials.size() == triangles
                && mesh.triangle_nodes.size() == triangles
                && (mesh.uvs.empty() || mesh.uvs.size() == mesh.positions.size()),
            "a mesh is whole", mesh.path);
    for (const auto& triangle : mesh.triangles)
        for (uint32_t vertex : triangle)
            require(vertex < mesh.positions.size(), "a corner is a vertex", std::to_string(vertex));
    for (const Imath::V3d& p : mesh.positions)
        require(std::isfinite(p.x) && std::isfinite(p.y) && std::isfinite(p.z), "positions are finite", said(p));
    for (const Imath::V3f& n : mesh.normals)
        require(n == Imath::V3f(0) || std::abs(n.length() - 1) < 1e-5, "normals are of unit length", said(n));
    for (uint32_t node : mesh.triangle_nodes)
        require(node < mesh.nodes.size(), "a triangle's node exists", std::to_string(node));
    for (size_t node = 0; node < mesh.nodes.size(); ++node)
        require(mesh.nodes[node].parent < int(node), "parents come first", std::to_string(node));
}

} // namespace vmlight::fuzz
