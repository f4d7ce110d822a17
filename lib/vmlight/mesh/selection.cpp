// SPDX-License-Identifier: Apache-2.0
#include <vmlight/mesh/selection.h>

#include <vmlight/base/format.h>
#include <vmlight/base/picked.h>
#include <vmlight/base/text_format.h>
#include <vmlight/mesh/opacity.h>

#include <OpenImageIO/strutil.h>

#include <algorithm>
#include <set>

namespace vmlight {
namespace {

constexpr size_t kMostSuggested = 3, kMostListed = 8;

// A name of the file, which can be anything.
std::string shown_name(std::string name, const char* kind, size_t index)
{
    std::replace_if(
        name.begin(), name.end(), [](char c) { return static_cast<unsigned char>(c) < 0x20 || c == 0x7f; }, ' ');
    return name.empty() ? format("{}_{}", kind, index) : name;
}

bool matches(OIIO::string_view name, OIIO::string_view pattern)
{
    size_t at = 0, next = 0, star = OIIO::string_view::npos, after_star = 0;
    while (at < name.size()) {
        if (next < pattern.size() && pattern[next] == '*') {
            star = next++;
            after_star = at;
        } else if (next < pattern.size() && pattern[next] == name[at]) {
            ++next, ++at;
        } else if (star != OIIO::string_view::npos) {
            next = star + 1;
            at = ++after_star; // the star takes one character more
        } else {
            return false;
        }
    }
    while (next < pattern.size() && pattern[next] == '*')
        ++next;
    return next == pattern.size();
}

std::vector<std::string> without_duplicates(const std::vector<std::string>& names)
{
    std::vector<std::string> unique;
    std::set<std::string> known;
    for (const std::string& name : names)
        if (known.insert(name).second)
            unique.push_back(name);
    return unique;
}

std::string quoted_list(const std::vector<std::string>& names, size_t most, const char* last)
{
    std::vector<std::string> shown;
    for (size_t i = 0; i < std::min(names.size(), most); ++i)
        shown.push_back(format("\"{}\"", shortened_line(names[i])));
    if (names.size() > most)
        return OIIO::Strutil::join(shown, ", ") + format(" and {} more", names.size() - most);
    std::string text = OIIO::Strutil::join(shown, ", ");
    const size_t comma = shown.size() > 1 ? text.size() - shown.back().size() - 2 : std::string::npos;
    return comma == std::string::npos ? text : text.replace(comma, 2, format(" {} ", last));
}

std::vector<std::string> near_names(const std::string& name, const std::vector<std::string>& known)
{
    std::vector<std::string> near { nearest_name(name, known) };
    for (const std::string& other : known)
        if (OIIO::Strutil::icontains(other, name))
            near.push_back(other);
    near = without_duplicates(near);
    near.erase(std::remove(near.begin(), near.end(), ""), near.end());
    near.resize(std::min(near.size(), kMostSuggested));
    return near;
}

std::string unknown_name(const char* kind, const std::string& name, const std::vector<std::string>& names)
{
    const std::vector<std::string> known = without_duplicates(names);
    const std::vector<std::string> near = near_names(name, known);
    std::string text = format("no {} \"{}\"; ", kind, shortened_line(name));
    text += known.empty() ? "this file has none" : format("the file has {}", quoted_list(known, kMostListed, "and"));
    return near.empty() ? text : text + format("; did you mean {}?", quoted_list(near, kMostSuggested, "or"));
}

// Mark the elements of `names` that one of `wanted` names. False, with the reason in `error`, if one names none.
bool mark_named(std::vector<bool>& dst, const std::vector<std::string>& names, const std::vector<std::string>& wanted,
                const char* kind, std::string& error)
{
    dst.assign(names.size(), false);
    for (const std::string& name : wanted) {
        const bool is_exact = std::find(names.begin(), names.end(), name) != names.end();
        bool found = false;
        for (size_t i = 0; i < names.size(); ++i)
            if (is_exact ? names[i] == name : matches(names[i], name))
                dst[i] = found = true;
        if (!found) {
            error = unknown_name(kind, name, names);
            return false;
        }
    }
    return true;
}

// Take away the triangles whose index is not marked.
void keep_marked(std::vector<bool>& triangles, const TriangleIndices& indices, const std::vector<bool>& marked)
{
    for (size_t t = 0; t < triangles.size(); ++t)
        triangles[t] = triangles[t] && t < indices.size() && indices[t] < marked.size() && marked[indices[t]];
}

bool is_textured(const Mesh& mesh, const std::array<uint32_t, 3>& triangle)
{
    return std::all_of(triangle.begin(), triangle.end(), [&](uint32_t vertex) { return has_uv(mesh, vertex); });
}

} // namespace

std::string material_name(const Mesh& mesh, size_t index)
{
    return shown_name(mesh.materials[index].name, "material", index);
}

std::string node_name(const Mesh& mesh, size_t index)
{
    return shown_name(mesh.nodes[index].name, "node", index);
}

std::vector<std::string> baked_materials(const Mesh& mesh)
{
    std::vector<bool> used(mesh.materials.size(), false);
    for (size_t t = 0; t < mesh.triangle_materials.size(); ++t)
        if (mesh.triangle_materials[t] < used.size() && is_textured(mesh, mesh.triangles[t]))
            used[mesh.triangle_materials[t]] = true;
    std::vector<std::string> names;
    for (size_t i = 0; i < used.size(); ++i)
        if (used[i])
            names.push_back(material_name(mesh, i));
    return without_duplicates(names);
}

std::vector<std::string> baked_instances(const Mesh& mesh)
{
    std::vector<bool> used(mesh.nodes.size(), false);
    for (size_t t = 0; t < mesh.triangle_nodes.size(); ++t) {
        if (!is_textured(mesh, mesh.triangles[t]))
            continue;
        // The innermost instance around the triangle.
        auto node = int(mesh.triangle_nodes[t]);
        while (node >= 0 && !mesh.nodes[size_t(node)].is_instance)
            node = mesh.nodes[size_t(node)].parent;
        if (node >= 0)
            used[size_t(node)] = true;
    }
    std::vector<std::string> names;
    for (size_t i = 0; i < used.size(); ++i)
        if (used[i])
            names.push_back(node_name(mesh, i));
    return names;
}

bool choose_triangles(std::vector<bool>& dst, const Mesh& mesh, const MeshSelection& selection, std::string& at,
                      std::string& error)
{
    const std::string& path = mesh.path.empty() ? mesh.name : mesh.path;
    dst.assign(mesh.triangles.size(), true);
    std::vector<std::string> names;
    std::vector<bool> marked;
    std::string reason;
    at = "material";
    if (!selection.material.empty()) {
        for (size_t i = 0; i < mesh.materials.size(); ++i)
            names.push_back(material_name(mesh, i));
        if (mark_named(marked, names, selection.material, "material", reason))
            keep_marked(dst, mesh.triangle_materials, marked);
        if (reason.empty() && std::find(dst.begin(), dst.end(), true) == dst.end())
            reason = format("no triangle has the material \"{}\"", shortened_line(selection.material.front()));
    }
    if (reason.empty() && !selection.node.empty()) {
        at = "node";
        names.clear();
        for (size_t i = 0; i < mesh.nodes.size(); ++i)
            names.push_back(node_name(mesh, i));
        if (mark_named(marked, names, selection.node, "node", reason)) {
            for (size_t i = 0; i < marked.size(); ++i)
                marked[i] = marked[i] || (mesh.nodes[i].parent >= 0 && marked[size_t(mesh.nodes[i].parent)]);
            keep_marked(dst, mesh.triangle_nodes, marked);
        }
        if (reason.empty() && std::find(dst.begin(), dst.end(), true) == dst.end())
            reason = format("no triangle {}is below the node \"{}\"",
                            selection.material.empty() ? "" : "has the material and ",
                            shortened_line(selection.node.front()));
    }
    if (!reason.empty())
        error = format("\"{}\": {}", path, reason);
    return reason.empty();
}

Mesh mesh_part(const Mesh& mesh, const std::vector<bool>& chosen)
{
    Mesh part;
    part.name = mesh.name;
    part.path = mesh.path;
    part.has_exact_positions = mesh.has_exact_positions;
    part.materials = mesh.materials;
    part.nodes = mesh.nodes;
    part.normals_from = mesh.normals_from;
    std::vector<size_t> triangles, vertices;
    std::vector<uint32_t> number(mesh.positions.size(), 0);
    bool has_uvs = false;
    for (size_t t = 0; t < mesh.triangles.size(); ++t)
        if (chosen[t]) {
            triangles.push_back(t);
            has_uvs = has_uvs || is_textured(mesh, mesh.triangles[t]);
            for (const uint32_t vertex : mesh.triangles[t])
                number[vertex] = 1;
        }
    for (size_t v = 0; v < number.size(); ++v)
        if (number[v]) {
            number[v] = uint32_t(vertices.size());
            vertices.push_back(v);
        }
    part.positions = picked(mesh.positions, vertices);
    part.normals = picked(mesh.normals, vertices);
    if (has_uvs)
        part.uvs = picked(mesh.uvs, vertices);
    part.triangles = picked(mesh.triangles, triangles);
    for (auto& triangle : part.triangles)
        for (uint32_t& vertex : triangle)
            vertex = number[vertex];
    part.triangle_materials = picked(mesh.triangle_materials, triangles);
    part.triangle_nodes = picked(mesh.triangle_nodes, triangles);
    if (mesh.opacity)
        part.opacity = opacity_part(*mesh.opacity, triangles);
    return part;
}

} // namespace vmlight
