// SPDX-License-Identifier: Apache-2.0
#include <vmlight/mesh/import/fbx.h>

#include <vmlight/base/words.h>
#include <vmlight/mesh/import/fbx_records.h>
#include <vmlight/mesh/import/node_graph.h>

#include <OpenImageIO/filesystem.h>
#include <OpenImageIO/strutil.h>

#include <algorithm>
#include <cstdint>
#include <unordered_map>
#include <utility>
#include <vector>

namespace vmlight {
namespace {

using OIIO::Strutil::fmt::format;

constexpr int kDeepestModels = 5000; // assimp makes up to 18 nodes of each
constexpr size_t kMoreModels = 50000; // that come of Models under several others, which no exporter is known to write

// The digits at its start, as assimp has them: what is beyond 64 bits is 0 or wraps.
int64_t id_of(const std::string& text)
{
    uint64_t id = 0;
    for (size_t i = 0; i < text.size() && text[i] >= '0' && text[i] <= '9'; ++i) {
        const uint64_t next = id * 10 + uint64_t(text[i] - '0');
        if (next < id)
            return 0;
        id = next;
    }
    return int64_t(id);
}

// The Models, and what is connected.
class Models
{
public:
    /// @param list     the top-level record that `record` is in
    void add(const std::string& list, const std::string& record, const std::vector<std::string>& properties)
    {
        if (list == "Objects" && record == "Model" && !properties.empty()) {
            m_names[id_of(properties[0])] = properties.size() > 1 ? properties[1] : "";
        } else if (list == "Connections" && record == "C" && properties.size() > 2) {
            const std::string& type = properties[0];
            const bool is_of_property = type == "OP" && properties.size() > 3 && !properties[3].empty();
            if (type != "PP" && !is_of_property) // of other types assimp takes any for "OO"
                m_children_and_parents.emplace_back(id_of(properties[1]), id_of(properties[2]));
        }
    }

    std::string fault() const
    {
        constexpr int64_t kRoot = 0;
        MeshNodeGraph<int64_t> graph(m_children_and_parents.size() + kMoreModels, kDeepestModels);
        for (const auto& [child, parent] : m_children_and_parents)
            if (m_names.count(child) && (parent == kRoot || m_names.count(parent)))
                graph.add(parent, child);
        return graph.fault(kRoot, [&](int64_t id) { return name_of(id); });
    }

private:
    // Text has "Model::A", binary "A", zero, one, "Model".
    std::string name_of(int64_t id) const
    {
        const auto known = m_names.find(id);
        std::string name = known == m_names.end() ? "" : known->second;
        name.resize(std::min(name.size(), name.find('\0')));
        if (OIIO::Strutil::starts_with(name, "Model::"))
            name.erase(0, 7);
        return format("\"{}\"", reason_line(name));
    }

    std::unordered_map<int64_t, std::string> m_names;
    std::vector<std::pair<int64_t, int64_t>> m_children_and_parents;
};

} // namespace

std::string fbx_fault(const std::string& bytes)
{
    Models models;
    const std::string fault = read_fbx_records(
        bytes, [&](const std::string& list, const std::string& record, const std::vector<std::string>& properties) {
            models.add(list, record, properties);
        });
    return fault.empty() ? models.fault() : fault;
}

MeshFile inspect_fbx(const std::string& path)
{
    using namespace OIIO;
    MeshFile file;
    std::string bytes(200, '\0');
    bytes.resize(Filesystem::read_bytes(path, bytes.data(), bytes.size()));
    if (!Strutil::iends_with(path, ".fbx") && !Strutil::icontains(bytes, "fbx"))
        return file;
    bytes.resize(Filesystem::file_size(path));
    bytes.resize(Filesystem::read_bytes(path, bytes.data(), bytes.size()));
    file.fault = fbx_fault(bytes);
    return file;
}

} // namespace vmlight
