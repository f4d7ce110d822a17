// SPDX-License-Identifier: Apache-2.0
#include <vmlight/mesh/import/scene_list.h>

#include <vmlight/base/format.h>
#include <vmlight/mesh/import/format_checks.h>
#include <vmlight/mesh/import/read_mesh.h>
#include <vmlight/mesh/instances.h>
#include <vmlight/mesh/selection.h>

#include <OpenImageIO/filesystem.h>
#include <OpenImageIO/strutil.h>

#include <algorithm>
#include <filesystem>
#include <map>
#include <memory>
#include <utility>

namespace vmlight {
namespace {

using Imath::M44d;

constexpr size_t kDeepest = 16;

/// Reads a list and those that it names.
class ListReader
{
public:
    ListReader(MeshBuilder& dst, const BeforeOpen& before_open)
        : m_dst(dst)
        , m_before_open(before_open)
    {
    }

    // The entries of the list at `path`, all of it placed by `to_object`, below `parent`.
    bool append(const std::string& path, const M44d& to_object, int parent, bool bakes, std::string& error)
    {
        std::error_code ignored;
        const std::string id = std::filesystem::weakly_canonical(path, ignored).string();
        if (std::find(m_open.begin(), m_open.end(), id) != m_open.end() || m_open.size() == kDeepest) {
            error = m_open.size() == kDeepest ? format("more than {} nested scene lists", kDeepest)
                                              : format("\"{}\" contains itself", path);
            return false;
        }
        m_open.push_back(id);
        if (m_before_open)
            m_before_open(path);
        std::vector<SceneListEntry> entries;
        bool good = parse_scene_list(entries, file_bytes(path), path, error);
        for (size_t i = 0; i < entries.size() && good; ++i) {
            good = append_entry(entries[i], entries[i].to_object * to_object, parent, bakes && entries[i].bake, error);
            if (!good)
                error = format("line {}: {}", entries[i].line, error);
        }
        m_open.pop_back();
        return good;
    }

    size_t baked() const { return m_baked; }

private:
    bool append_entry(const SceneListEntry& entry, const M44d& place, int parent, bool bakes, std::string& error)
    {
        if (is_scene_list(read_head(entry.mesh))) {
            if (!entry.material.empty()) {
                error = format("\"{}\" is a scene list, whose entries have materials of their own", entry.mesh);
                return false;
            }
            const uint32_t node = m_dst.add_node(entry.name, parent);
            // A list that is baked is baked as it says.
            if (append(entry.mesh, place, int(node), bakes, error))
                return true;
            error = format("\"{}\": {}", entry.mesh, error);
            return false;
        }
        if (bakes) {
            Mesh mesh;
            if (!read(mesh, entry, false, error))
                return false;
            const std::string name = entry.name.empty() ? OIIO::Filesystem::filename(entry.mesh) : entry.name;
            const uint32_t node = m_dst.add_node(name, parent);
            m_dst.mark_instance(node);
            m_dst.append_mesh(mesh, place, node);
            ++m_baked;
            return true;
        }
        std::vector<std::pair<uint32_t, M44d>>* parts = nullptr;
        if (!find_parts(parts, entry, error))
            return false;
        for (const auto& [distinct, to_entry] : *parts)
            m_dst.add_place(distinct, to_entry * place);
        return true;
    }

    bool read(Mesh& dst, const SceneListEntry& entry, bool keeps_instances, std::string& error)
    {
        const auto import = keeps_instances ? read_instanced_mesh : read_mesh;
        if (!import(dst, entry.mesh, m_dst.params(), error, m_before_open))
            return false;
        if (entry.material.empty())
            return true;
        const std::shared_ptr<MeshInstances> instances = std::move(dst.instances);
        const bool chosen = choose(dst, entry, error);
        if (!instances)
            return chosen;
        bool any = chosen;
        for (Mesh& mesh : instances->meshes)
            any |= choose(mesh, entry, error);
        dst.instances = instances;
        return any;
    }

    // Leaves the triangles that have the materials; none, with the reason, if no triangle has.
    static bool choose(Mesh& mesh, const SceneListEntry& entry, std::string& error)
    {
        std::vector<bool> chosen;
        std::string at;
        MeshSelection selection;
        selection.material = entry.material;
        const bool good = choose_triangles(chosen, mesh, selection, at, error);
        if (!good) {
            if (const std::string head = format("\"{}\": ", entry.mesh); !OIIO::Strutil::starts_with(error, head))
                error = head + error;
            mesh.triangles.clear();
            mesh.triangle_materials.clear();
            mesh.triangle_nodes.clear();
            return false;
        }
        const std::vector<std::string> warnings = std::move(mesh.warnings);
        const std::string path = mesh.path, name = mesh.name;
        mesh = mesh_part(mesh, chosen);
        mesh.warnings = warnings;
        mesh.path = path;
        mesh.name = name;
        return true;
    }

    // The distinct meshes of an entry, where they are in its file: each file and choice of materials is read once.
    bool find_parts(std::vector<std::pair<uint32_t, M44d>>*& dst, const SceneListEntry& entry, std::string& error)
    {
        const auto [known, is_new]
            = m_parts.emplace(entry.mesh + "\n" + OIIO::Strutil::join(entry.material, "\n"), Parts());
        dst = &known->second;
        if (!is_new)
            return true;
        Mesh mesh;
        if (!read(mesh, entry, true, error))
            return false;
        for (const std::string& warning : mesh.warnings)
            m_dst.warn(format("\"{}\": {}", entry.mesh, warning));
        const std::shared_ptr<MeshInstances> instances = std::move(mesh.instances);
        mesh.instances = nullptr;
        if (!mesh.triangles.empty())
            dst->push_back({ m_dst.add_distinct(std::move(mesh)), M44d() });
        if (!instances)
            return true;
        std::vector<uint32_t> numbers;
        for (Mesh& distinct : instances->meshes)
            numbers.push_back(m_dst.add_distinct(std::move(distinct)));
        for (const MeshInstances::Place& place : instances->places)
            dst->push_back({ numbers[place.mesh], place.to_object });
        return true;
    }

    using Parts = std::vector<std::pair<uint32_t, M44d>>;
    MeshBuilder& m_dst;
    const BeforeOpen& m_before_open;
    size_t m_baked = 0;
    std::vector<std::string> m_open; // lists that are being read
    std::map<std::string, Parts> m_parts;
};

} // namespace

bool is_scene_list(const FileHead& head)
{
    return OIIO::Strutil::contains(head.bytes, "[[instance]]");
}

bool read_scene_list(MeshBuilder& dst, const ImportRequest& request, std::string& error)
{
    ListReader reader(dst, request.before_open);
    if (!reader.append(request.path, M44d(), -1, !request.keeps_instances, error))
        return false;
    if (request.keeps_instances || reader.baked() > 0)
        return true;
    error = "a scene list of which nothing is baked: write bake = true to an instance, or pass the list as --occluder";
    return false;
}

} // namespace vmlight
