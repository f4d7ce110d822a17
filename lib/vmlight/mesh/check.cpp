// SPDX-License-Identifier: Apache-2.0
#include <vmlight/base/format.h>
#include <vmlight/mesh/mesh.h>
#include <vmlight/mesh/strands.h>

#include <cmath>

namespace vmlight {
namespace {

std::string find_error(const Mesh& mesh)
{
    const size_t count = mesh.positions.size();
    if (mesh.normals.size() != count)
        return format("{} normals for {} vertices", mesh.normals.size(), count);
    if (!mesh.uvs.empty() && mesh.uvs.size() != count)
        return format("{} texture coordinates for {} vertices", mesh.uvs.size(), count);
    for (size_t t = 0; t < mesh.triangles.size(); ++t)
        for (uint32_t vertex : mesh.triangles[t]) {
            if (vertex >= count)
                return format("triangle {} uses vertex {}, but there are only {}", t, vertex, count);
            const Imath::V3d& p = mesh.positions[vertex];
            if (!std::isfinite(p.x) || !std::isfinite(p.y) || !std::isfinite(p.z))
                return format("vertex {} is not finite: ({}, {}, {})", vertex, p.x, p.y, p.z);
        }
    return "";
}

} // namespace

bool check_mesh(const Mesh& mesh, std::string& error)
{
    const std::string reason = find_error(mesh);
    if (!reason.empty())
        error = format("\"{}\": {}", mesh.path.empty() ? mesh.name : mesh.path, reason);
    return reason.empty() && (!mesh.strands || check_strands(*mesh.strands, error));
}

} // namespace vmlight
