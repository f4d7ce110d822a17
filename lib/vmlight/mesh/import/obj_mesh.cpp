// SPDX-License-Identifier: Apache-2.0
#include <vmlight/base/format.h>
#include <vmlight/base/unique_index.h>
#include <vmlight/mesh/import/format_checks.h>
#include <vmlight/mesh/import/obj.h>
#include <vmlight/mesh/import/polygons.h>

#include <OpenImageIO/strutil.h>

#include <algorithm>
#include <optional>

namespace vmlight {
namespace {

using Imath::V2f;
using Imath::V3d;
using obj::Corner;
using obj::State;

// Do the vertices that faces use lose their shape in float?
bool is_far(const obj::File& file)
{
    std::vector<bool> used(file.positions.size());
    for (const Corner& corner : file.corners)
        used[size_t(corner.vertex)] = true;
    std::vector<V3d> positions;
    for (size_t i = 0; i < used.size(); ++i)
        if (used[i])
            positions.push_back(file.positions[i]);
    return is_far_from_origin(positions);
}

// The index of the material that `usemtl` names, added if it is not known.
uint32_t index_of(std::vector<Material>& materials, const std::string& name)
{
    const auto find = [&](const std::string& wanted) {
        return std::find_if(materials.begin(), materials.end(), [&](const Material& m) { return m.name == wanted; });
    };
    auto material = find(name);
    if (material == materials.end()) // a comment without a blank behind its sign
        material = find(OIIO::Strutil::rstrip(name.substr(0, name.find(" #"))));
    const size_t index = size_t(material - materials.begin());
    if (material == materials.end())
        materials.emplace_back().name = name;
    return uint32_t(index);
}

class ObjAppender
{
public:
    ObjAppender(MeshBuilder& dst, const obj::File& file, std::vector<Material> materials)
        : m_dst(dst)
        , m_file(file)
        , m_is_far(is_far(file))
        , m_has_uvs(dst.params().uv_set == 0)
    {
        if (m_is_far)
            dst.set_exact_positions();
        add_materials(std::move(materials));
        add_nodes();
    }

    V3d position(int32_t vertex) const
    {
        return m_is_far ? m_file.positions[size_t(vertex)] : V3d(m_file.rounded_positions[size_t(vertex)]);
    }

    bool append(std::string& error)
    {
        std::vector<uint32_t> ends;
        for (const obj::Face& face : m_file.faces)
            ends.push_back(face.end);
        return visit_triangles(
            ends, [&](uint32_t corner) { return position(m_file.corners[corner].vertex); }, m_is_far,
            [&](size_t face, const std::array<uint32_t, 3>& corners) { add_triangle(face, corners); }, error);
    }

private:
    void add_materials(std::vector<Material> materials)
    {
        for (const State& state : m_file.states)
            m_materials.push_back(
                index_of(materials, state.material < 0 ? "" : m_file.materials[size_t(state.material)]));
        for (Material& material : materials)
            m_dst.add_material(std::move(material));
    }

    void add_nodes()
    {
        for (const MeshNode& node : m_file.nodes)
            m_dst.add_node(node.name, node.parent);
        uint32_t nameless = 0;
        const auto has_none = [](const State& state) { return state.node < 0; };
        if (std::any_of(m_file.states.begin(), m_file.states.end(), has_none))
            nameless = m_dst.add_node("", -1);
        for (const State& state : m_file.states)
            m_nodes.push_back(has_none(state) ? nameless : uint32_t(state.node));
    }

    void begin_part(size_t first_face)
    {
        const auto part_of = [&](size_t face) { return m_file.states[m_file.faces[face].state].part; };
        size_t end = first_face;
        while (end < m_file.faces.size() && part_of(end) == part_of(first_face))
            ++end;
        const uint32_t begin_corner = first_face == 0 ? 0 : m_file.faces[first_face - 1].end;
        m_vertices.emplace(m_file.faces[end - 1].end - begin_corner);
        const State& state = m_file.states[m_file.faces[first_face].state];
        const uint32_t node = m_nodes[m_file.faces[first_face].state];
        m_dst.begin_part(state.node < 0 ? "" : m_file.nodes[size_t(state.node)].name, m_dst.root_transform(false),
                         node);
    }

    uint32_t vertex_of(const Corner& corner)
    {
        const uint32_t index = m_vertices->index_of({ corner.vertex, corner.uv, corner.normal });
        if (index == m_count) {
            ++m_count;
            const V2f* uv = m_has_uvs && corner.uv >= 0 ? &m_file.uvs[size_t(corner.uv)] : nullptr;
            m_dst.add_vertex(position(corner.vertex),
                             corner.normal < 0 ? V3d(0) : V3d(m_file.normals[size_t(corner.normal)]), uv);
        }
        return index;
    }

    void add_triangle(size_t face, const std::array<uint32_t, 3>& corners)
    {
        const uint32_t number = m_file.faces[face].state;
        const State& state = m_file.states[number];
        if (!m_vertices || state.part != m_part) {
            begin_part(face);
            m_part = state.part;
            m_count = 0;
        }
        m_dst.set_node(m_nodes[number]);
        std::array<uint32_t, 3> vertices {};
        for (size_t k = 0; k < 3; ++k)
            vertices[k] = vertex_of(m_file.corners[corners[k]]);
        m_dst.add_triangle(vertices, m_materials[number], state.smoothing);
    }

    MeshBuilder& m_dst;
    const obj::File& m_file;
    const bool m_is_far, m_has_uvs;
    std::vector<uint32_t> m_nodes, m_materials; // of each state
    std::optional<UniqueIndex<Corner>> m_vertices; // of the part
    uint32_t m_part = 0;
    size_t m_count = 0; // of vertices that the part has so far
};

} // namespace

bool append_obj(MeshBuilder& dst, const obj::File& file, std::vector<Material> materials, std::string& error)
{
    if (!file.ignored.empty())
        dst.warn(format("not read: statements \"{}\"; only polygons are", OIIO::Strutil::join(file.ignored, "\", \"")));
    return ObjAppender(dst, file, std::move(materials)).append(error);
}

} // namespace vmlight
