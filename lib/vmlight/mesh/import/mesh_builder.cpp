// SPDX-License-Identifier: Apache-2.0
#include <vmlight/mesh/import/mesh_builder.h>

#include <vmlight/base/format.h>
#include <vmlight/base/text_format.h>
#include <vmlight/mesh/instances.h>

#include <OpenImageIO/strutil.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>

namespace vmlight {

using Imath::V2f;
using Imath::V3d;
using Imath::V3f;

namespace {

bool is_finite(const V3d& v)
{
    return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z);
}

// Areas and their squares still fit a double. Every float is in range.
bool is_in_range(const V3d& v)
{
    constexpr double kFarthest = 1e70;
    return std::abs(v.x) <= kFarthest && std::abs(v.y) <= kFarthest && std::abs(v.z) <= kFarthest;
}

} // namespace

Imath::M44d MeshBuilder::root_transform(bool is_file_z_up) const
{
    Imath::M44d to_y_up;
    if (m_params.up == "z" || (m_params.up == "file" && is_file_z_up))
        to_y_up = Imath::M44d(1, 0, 0, 0, 0, 0, -1, 0, 0, 1, 0, 0, 0, 0, 0, 1); // (x, y, z) -> (x, z, -y)
    return to_y_up;
}

uint32_t MeshBuilder::add_material(Material material)
{
    m_mesh.materials.push_back(std::move(material));
    return uint32_t(m_mesh.materials.size() - 1);
}

uint32_t MeshBuilder::add_node(const std::string& name, int parent)
{
    m_mesh.nodes.push_back({ name, parent, false });
    return uint32_t(m_mesh.nodes.size() - 1);
}

uint32_t MeshBuilder::add_distinct(Mesh mesh)
{
    if (!m_mesh.instances)
        m_mesh.instances = std::make_shared<MeshInstances>();
    m_mesh.instances->meshes.push_back(std::move(mesh));
    return uint32_t(m_mesh.instances->meshes.size() - 1);
}

void MeshBuilder::add_place(uint32_t distinct, const Imath::M44d& to_object)
{
    m_mesh.instances->places.push_back({ distinct, to_object });
}

void MeshBuilder::append_mesh(const Mesh& mesh, const Imath::M44d& to_object, uint32_t node)
{
    const auto first_node = int(m_mesh.nodes.size());
    const auto first_material = uint32_t(m_mesh.materials.size());
    for (const MeshNode& inner : mesh.nodes)
        add_node(inner.name, inner.parent < 0 ? int(node) : first_node + inner.parent);
    for (const Material& material : mesh.materials)
        add_material(material);
    for (const std::string& warning : mesh.warnings)
        warn(warning);
    begin_part(mesh.name, to_object, node);
    for (size_t v = 0; v < mesh.positions.size(); ++v)
        add_vertex(mesh.positions[v], V3d(mesh.normals[v]), has_uv(mesh, uint32_t(v)) ? &mesh.uvs[v] : nullptr);
    for (size_t t = 0; t < mesh.triangles.size(); ++t) {
        if (t < mesh.triangle_nodes.size())
            set_node(uint32_t(first_node) + mesh.triangle_nodes[t]);
        add_triangle(mesh.triangles[t],
                     first_material + (t < mesh.triangle_materials.size() ? mesh.triangle_materials[t] : 0));
    }
    if (!mesh.instances)
        return;
    std::vector<uint32_t> numbers;
    for (const Mesh& distinct : mesh.instances->meshes)
        numbers.push_back(add_distinct(distinct));
    for (const MeshInstances::Place& place : mesh.instances->places)
        add_place(numbers[place.mesh], place.to_object * to_object);
}

void MeshBuilder::reserve(size_t vertices, size_t triangles)
{
    m_mesh.positions.reserve(vertices);
    m_mesh.normals.reserve(vertices);
    m_mesh.uvs.reserve(vertices);
    m_mesh.triangles.reserve(triangles);
    m_mesh.triangle_materials.reserve(triangles);
    m_mesh.triangle_nodes.reserve(triangles);
    m_groups.reserve(triangles);
}

void MeshBuilder::warn(const std::string& sentence)
{
    std::string line = shortened_line(sentence);
    if (std::find(m_mesh.warnings.begin(), m_mesh.warnings.end(), line) == m_mesh.warnings.end())
        m_mesh.warnings.push_back(std::move(line));
}

void MeshBuilder::begin_part(const std::string& name, const Imath::M44d& to_object, uint32_t node)
{
    m_node = node;
    m_part = name;
    m_to_object = to_object;
    m_normals_to_object = to_object.inverse().transposed();
    m_is_mirrored = to_object.determinant() < 0;
    m_first = m_mesh.positions.size();
}

void MeshBuilder::add_vertex(const V3d& position, const V3d& normal, const V2f* uv)
{
    V3d object_position, object_normal;
    m_to_object.multVecMatrix(position, object_position);
    if (!is_in_range(object_position) && m_error.empty()) {
        const bool is_transform = is_in_range(position);
        const V3d& bad = is_transform ? object_position : position;
        m_error = format("vertex {} of \"{}\" is {}{}: ({}, {}, {})", m_mesh.positions.size() - m_first, m_part,
                         is_finite(bad) ? "farther than 1e70 from the origin" : "not finite",
                         is_transform ? " after its node's transform" : "", bad.x, bad.y, bad.z);
    }
    m_mesh.positions.push_back(object_position);

    m_normals_to_object.multDirMatrix(normal, object_normal);
    m_mesh.normals.push_back(V3f(is_finite(object_normal) ? object_normal.normalized() : V3d(0)));

    const float nan = std::numeric_limits<float>::quiet_NaN();
    m_mesh.uvs.push_back(uv ? *uv : V2f(nan, nan));
    m_has_uvs |= uv != nullptr;
}

void MeshBuilder::add_triangle(std::array<uint32_t, 3> corners, uint32_t material, uint32_t smoothing_group)
{
    const size_t count = m_mesh.positions.size() - m_first;
    for (uint32_t& corner : corners) {
        if (corner >= count && m_error.empty())
            m_error = format("a triangle of \"{}\" uses vertex {}, but there are only {}", m_part, corner, count);
        corner += uint32_t(m_first);
    }
    if (m_is_mirrored)
        std::swap(corners[1], corners[2]); // a mirror turns the winding inside out
    m_mesh.triangles.push_back(corners);
    m_mesh.triangle_materials.push_back(material);
    m_mesh.triangle_nodes.push_back(m_node);
    if (smoothing_group != kFlatGroup && smoothing_group != kSmoothGroup)
        smoothing_group
            = m_group_numbers.emplace(std::pair(m_first, smoothing_group), uint32_t(m_group_numbers.size() + 1))
                  .first->second;
    m_groups.push_back(smoothing_group);
}

void MeshBuilder::compute_normals()
{
    const size_t count = m_mesh.triangles.size();
    if (m_params.normals == "flat") {
        m_mesh.normals_from = "flat";
        make_flat_normals(m_mesh);
        return;
    }
    if (m_params.normals == "smooth") {
        m_mesh.normals_from = "smooth";
        make_smooth_normals(m_mesh, m_params.crease_angle);
        return;
    }
    size_t flat = 0, smooth = 0, grouped = 0;
    for (size_t t = 0; t < count; ++t) {
        const auto& triangle = m_mesh.triangles[t];
        if (std::none_of(triangle.begin(), triangle.end(),
                         [&](uint32_t vertex) { return is_missing_normal(m_mesh.normals[vertex]); }))
            continue;
        ++(m_groups[t] == kFlatGroup ? flat : m_groups[t] == kSmoothGroup ? smooth : grouped);
    }
    std::vector<std::string> rules;
    const auto add_rule = [&](size_t triangles, const char* rule) {
        if (triangles == count)
            rules.push_back(rule);
        else if (triangles > 0)
            rules.push_back(format("{} for {} of {} triangles", rule, triangles, count));
    };
    add_rule(flat, "flat");
    add_rule(grouped, "smooth within smoothing groups");
    add_rule(smooth, m_seam_angle < 180 ? "smooth but for sharp UV seams" : "smooth");
    if (flat + smooth + grouped < count)
        rules.push_back(rules.empty() ? "from the file" : "else from the file");
    m_mesh.normals_from = OIIO::Strutil::join(rules, ", ");
    if (!m_has_unique_vertices)
        fill_missing_normals(m_mesh, m_params.crease_angle, m_groups, m_seam_angle);
}

bool MeshBuilder::finish(std::string& error)
{
    if (!m_error.empty() || (m_mesh.triangles.empty() && !m_mesh.instances)) {
        error = m_error.empty() ? "no triangles" : shortened_line(m_error);
        return false;
    }
    if (!m_has_uvs)
        m_mesh.uvs.clear();
    compute_normals();
    warn_of_heights();
    return true;
}

void MeshBuilder::warn_of_heights()
{
    std::vector<bool> is_used(m_mesh.materials.size());
    for (const uint32_t material : m_mesh.triangle_materials)
        if (material < is_used.size())
            is_used[material] = true;
    std::vector<std::string> names;
    for (size_t i = 0; i < is_used.size(); ++i)
        if (is_used[i] && m_mesh.materials[i].has_heights)
            names.push_back(m_mesh.materials[i].name);
    if (!names.empty())
        warn(format("{} (\"{}\"{}) {} a bump or displacement map, which is not read: bake it to a normal map",
                    count_text(int64_t(names.size()), "material", "materials"), names[0],
                    names.size() > 1 ? ", ..." : "", plural(int64_t(names.size()), "has", "have")));
}

} // namespace vmlight
