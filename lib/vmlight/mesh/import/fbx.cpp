// SPDX-License-Identifier: Apache-2.0
#include <vmlight/base/format.h>
#include <vmlight/base/text_format.h>
#include <vmlight/mesh/import/fbx_records.h>
#include <vmlight/mesh/import/format_checks.h>
#include <vmlight/mesh/import/node_graph.h>

#include <OpenImageIO/strutil.h>

#include <algorithm>
#include <cstdint>
#include <unordered_map>
#include <utility>
#include <vector>

namespace vmlight {
namespace {

// The leading digits, as assimp reads them: beyond 64 bits they are 0 or wrap.
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

// Models and connections.
class Models
{
public:
    /// @param list     the top-level record that contains `record`
    void add(const std::string& list, const std::string& record, const std::vector<std::string>& properties)
    {
        if (list == "Objects" && record == "Model" && !properties.empty()) {
            m_names[id_of(properties[0])] = properties.size() > 1 ? properties[1] : "";
        } else if (list == "Connections" && record == "C" && properties.size() > 2) {
            const std::string& type = properties[0];
            const bool is_of_property = type == "OP" && properties.size() > 3 && !properties[3].empty();
            if (type != "PP" && !is_of_property) // assimp treats every other type as "OO"
                m_children_and_parents.emplace_back(id_of(properties[1]), id_of(properties[2]));
        }
    }

    std::string hierarchy_error(const NodeLimits& limits) const
    {
        constexpr int64_t kRoot = 0;
        NodeGraph<int64_t> graph({ m_children_and_parents.size() + limits.nodes, limits.depth });
        for (const auto& [child, parent] : m_children_and_parents)
            if (m_names.count(child) && (parent == kRoot || m_names.count(parent)))
                graph.add(parent, child);
        return graph.error(kRoot, [&](int64_t id) { return name_of(id); });
    }

private:
    // "Model::A" in text, "A\0\1Model" in binary.
    std::string name_of(int64_t id) const
    {
        const auto known = m_names.find(id);
        std::string name = known == m_names.end() ? "" : known->second;
        name.resize(std::min(name.size(), name.find('\0')));
        if (OIIO::Strutil::starts_with(name, "Model::"))
            name.erase(0, 7);
        return format("\"{}\"", shortened_line(name));
    }

    std::unordered_map<int64_t, std::string> m_names;
    std::vector<std::pair<int64_t, int64_t>> m_children_and_parents;
};

} // namespace

bool is_fbx(const FileHead& head)
{
    using OIIO::Strutil::icontains, OIIO::Strutil::istarts_with, OIIO::Strutil::starts_with;
    const OIIO::string_view text = first_text(head);
    return starts_with(text, kFbxMagic) || istarts_with(text, "FBXHeaderExtension")
        || (starts_with(text, ";") && icontains(text.substr(0, 200), "fbx"));
}

Inspection inspect_fbx(const std::string& bytes, const NodeLimits& limits)
{
    Models models;
    Inspection result;
    result.error = read_fbx_records(
        bytes, [&](const std::string& list, const std::string& record, const std::vector<std::string>& properties) {
            models.add(list, record, properties);
        });
    if (result.error.empty())
        result.error = models.hierarchy_error(limits);
    return result;
}

} // namespace vmlight
