// SPDX-License-Identifier: Apache-2.0
#include <vmlight/mesh/same_triangles.h>

#include <vmlight/base/format.h>
#include <vmlight/base/text_format.h>

#include <cmath>

namespace vmlight {
namespace {

bool is_same(float a, float b)
{
    return a == b || (std::isnan(a) && std::isnan(b)); // a vertex without texture coordinates
}

const std::string& name_of(const Mesh& mesh)
{
    return mesh.path.empty() ? mesh.name : mesh.path;
}

} // namespace

std::string triangles_fault(const Mesh& mesh, const Mesh& pose)
{
    if (mesh.triangles.size() != pose.triangles.size())
        return format("\"{}\" has {}, and \"{}\" has {}: poses have the same triangles", name_of(pose),
                      count_text(int64_t(pose.triangles.size()), "triangle", "triangles"), name_of(mesh),
                      mesh.triangles.size());
    for (size_t t = 0; t < mesh.triangles.size(); ++t)
        for (size_t k = 0; k < 3 && !(mesh.uvs.empty() && pose.uvs.empty()); ++k) {
            const Imath::V2f none(NAN);
            const Imath::V2f a = mesh.uvs.empty() ? none : mesh.uvs[mesh.triangles[t][k]];
            const Imath::V2f b = pose.uvs.empty() ? none : pose.uvs[pose.triangles[t][k]];
            if (!is_same(a.x, b.x) || !is_same(a.y, b.y))
                return format(
                    "triangle {} of \"{}\" has the texture coordinates ({:.6g}, {:.6g}), and ({:.6g}, {:.6g}) in "
                    "\"{}\": poses have the same ones",
                    t, name_of(pose), b.x, b.y, a.x, a.y, name_of(mesh));
        }
    return "";
}

} // namespace vmlight
