// SPDX-License-Identifier: Apache-2.0
#include <vmlight/mesh/import/ply_roles.h>

#include <algorithm>
#include <map>

namespace vmlight::ply {
namespace {

const std::map<std::string, Role> kVertexRoles {
    { "x", kX }, { "y", kY },  { "z", kZ },         { "nx", kNormalX },  { "ny", kNormalY },  { "nz", kNormalZ },
    { "u", kU }, { "s", kU },  { "tx", kU },        { "texture_u", kU }, { "texture_s", kU }, { "v", kV },
    { "t", kV }, { "ty", kV }, { "texture_v", kV }, { "texture_t", kV },
};
const std::map<std::string, Role> kFaceRoles {
    { "vertex_indices", kCorners }, { "vertex_index", kCorners }, { "texcoord", kUvs }, { "texnumber", kTexture }
};

} // namespace

Roles roles_of(const Element& element)
{
    const bool is_vertex = element.name == "vertex";
    const bool is_face = element.name == "face" || element.name == "tristrips";
    Roles roles;
    for (const Property& property : element.properties) {
        const auto& known = is_vertex ? kVertexRoles : kFaceRoles;
        const auto role = known.find(property.name);
        const bool is_known = (is_vertex || is_face) && role != known.end();
        const bool is_list = is_known && (role->second == kCorners || role->second == kUvs);
        roles.push_back(is_known && is_list == bool(property.count) ? role->second : kNone);
    }
    return roles;
}

bool has_role(const Roles& roles, Role role)
{
    return std::find(roles.begin(), roles.end(), role) != roles.end();
}

VertexParts::VertexParts(const Element& element, const Roles& roles)
    : has_normals(has_role(roles, kNormalX) && has_role(roles, kNormalY) && has_role(roles, kNormalZ))
    , has_uvs(has_role(roles, kU) && has_role(roles, kV))
{
    for (size_t i = 0; i < roles.size(); ++i)
        has_doubles |= roles[i] <= kZ && element.properties[i].type->bytes == 8;
}

} // namespace vmlight::ply
