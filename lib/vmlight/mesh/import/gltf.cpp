// SPDX-License-Identifier: Apache-2.0
#include <vmlight/base/format.h>
#include <vmlight/mesh/import/format_checks.h>
#include <vmlight/mesh/import/node_graph.h>

#include <OpenImageIO/strutil.h>

#include <nlohmann/json.hpp>

#include <algorithm>
#include <utility>
#include <vector>

namespace vmlight {
namespace {

using nlohmann::json;

constexpr int kMaxDepth = 1000; // of brackets; a glTF has about ten

// The JSON: all of a .gltf, the first chunk of a GLB. Assimp stops at a zero, and accepts any bytes in a string: bytes
// that are not ASCII, which only strings hold, become question marks.
std::string json_of(const std::string& bytes)
{
    constexpr size_t kHeader = 20;
    std::string text;
    if (bytes.compare(0, 4, "glTF") != 0 || bytes.size() < kHeader) {
        text = bytes;
    } else {
        size_t length = 0;
        for (size_t i = 0; i < 4; ++i)
            length |= size_t(uint8_t(bytes[12 + i])) << (8 * i);
        text = bytes.substr(kHeader, length);
    }
    text.resize(std::min(text.size(), text.find('\0')));
    std::replace_if(
        text.begin(), text.end(), [](char c) { return uint8_t(c) > 127; }, '?');
    return text;
}

// Collects the children of nodes and the roots of scenes from a stream of JSON. (Parsing to a tree with a callback that
// drops the rest takes quadratic time in nlohmann 3.11.)
class NodeCollector : public nlohmann::json_sax<json>
{
public:
    bool is_too_deep() const { return m_depth > kMaxDepth; }
    size_t node_count() const { return m_node_count; }
    const std::vector<std::pair<size_t, size_t>>& parents_and_children() const { return m_parents_and_children; }
    const std::vector<std::pair<size_t, size_t>>& scenes_and_roots() const { return m_scenes_and_roots; }
    size_t scene() const { return m_scene; }

    bool start_object(size_t) override { return open(); }
    bool start_array(size_t) override { return open(); }
    bool end_object() override { return close(); }
    bool end_array() override { return close(); }
    bool null() override { return value(); }
    bool boolean(bool) override { return value(); }
    bool number_integer(int64_t) override { return value(); }
    bool number_float(double, const std::string&) override { return value(); }
    bool string(std::string&) override { return value(); }
    bool binary(json::binary_t&) override { return value(); }
    bool parse_error(size_t, const std::string&, const nlohmann::detail::exception&) override { return false; }

    bool key(std::string& name) override
    {
        if (m_depth == 1)
            m_outer = name;
        else if (m_depth == 3)
            m_inner = name;
        return true;
    }

    bool number_unsigned(uint64_t number) override
    {
        if (m_depth == 1 && m_outer == "scene")
            m_scene = number;
        else if (m_depth == 4 && m_outer == "scenes" && m_inner == "nodes")
            m_scenes_and_roots.emplace_back(m_scene_count - 1, number);
        else if (m_depth == 4 && m_outer == "nodes" && m_inner == "children")
            m_parents_and_children.emplace_back(m_node_count - 1, number);
        return value();
    }

private:
    // Depth 1 is the root, 2 its "nodes" or "scenes", 3 one of them, 4 its "children" or "nodes".
    bool open()
    {
        value();
        return ++m_depth <= kMaxDepth;
    }

    bool close()
    {
        --m_depth;
        return true;
    }

    bool value()
    {
        m_node_count += m_depth == 2 && m_outer == "nodes";
        m_scene_count += m_depth == 2 && m_outer == "scenes";
        return true;
    }

    int m_depth = 0;
    size_t m_node_count = 0, m_scene_count = 0, m_scene = 0;
    std::string m_outer, m_inner;
    std::vector<std::pair<size_t, size_t>> m_parents_and_children, m_scenes_and_roots;
};

// Why the node hierarchy of a glTF or GLB must not be read, or "".
std::string hierarchy_error(const std::string& bytes)
{
    NodeCollector nodes;
    const bool is_json = json::sax_parse(json_of(bytes), &nodes);
    if (nodes.is_too_deep())
        return format("JSON is nested more than {} deep", kMaxDepth);
    if (!is_json)
        return "";
    const size_t none = nodes.node_count();
    std::vector<size_t> parents(none, none);
    for (const auto& [parent, child] : nodes.parents_and_children()) {
        if (child >= none)
            continue;
        if (parents[child] != none)
            return format("node {} has two parents: {} and {}", child, parents[child], parent);
        parents[child] = parent;
    }
    NodeGraph<size_t> graph;
    for (const auto& [parent, child] : nodes.parents_and_children())
        graph.add(parent, child);
    for (const auto& [scene, root] : nodes.scenes_and_roots())
        if (scene == nodes.scene())
            graph.add(none, root); // `none` is the scene
    return graph.error(none, [](size_t node) { return format("{}", node); });
}

} // namespace

bool is_gltf(const FileHead& head)
{
    const OIIO::string_view text = first_text(head);
    return OIIO::Strutil::starts_with(head.bytes, "glTF")
        || (OIIO::Strutil::starts_with(text, "{") && OIIO::Strutil::contains(text, "\"asset\""));
}

Inspection inspect_gltf(const std::string& bytes)
{
    Inspection result;
    result.error = hierarchy_error(bytes);
    return result;
}

} // namespace vmlight
