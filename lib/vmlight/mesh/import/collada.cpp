// SPDX-License-Identifier: Apache-2.0
#include <vmlight/base/format.h>
#include <vmlight/mesh/import/format_checks.h>
#include <vmlight/mesh/import/node_graph.h>

#include <OpenImageIO/strutil.h>

#include <pugixml.hpp>

#include <algorithm>
#include <cstring>
#include <string>
#include <unordered_map>
#include <unordered_set>
#include <vector>

namespace vmlight {
namespace {

using pugi::xml_node;

bool is(const xml_node& element, const char* name)
{
    return std::strcmp(element.name(), name) == 0;
}

// The id or name that a url refers to. "" refers to an element without one.
std::string target_of(const xml_node& element)
{
    const char* url = element.attribute("url").value();
    return url[0] == '#' ? url + 1 : url;
}

// The nodes, found as assimp does: first in its library, which has top-level nodes and whole visual scenes, the last of
// each id; then in the visual scene that is instanced, the first of that id or name.
class NodeCollector : public pugi::xml_tree_walker
{
public:
    explicit NodeCollector(const NodeLimits& limits)
        : m_limits(limits)
    {
    }

    bool is_too_deep() const { return m_is_too_deep; }

    bool for_each(xml_node& element) override
    {
        m_is_too_deep |= depth() >= m_limits.depth;
        const bool is_visual_scene = is(element, "visual_scene");
        if (is_visual_scene || (is(element, "node") && is(element.parent(), "library_nodes")))
            m_library[element.attribute("id").value()] = element;
        if (is(element, "instance_visual_scene"))
            m_instanced = target_of(element);
        if (is_visual_scene || is(element, "node"))
            m_nodes.push_back(element);
        return !m_is_too_deep;
    }

    std::string hierarchy_error()
    {
        const auto instanced = m_library.find(m_instanced);
        if (instanced == m_library.end())
            return "";
        const xml_node root = instanced->second;
        std::unordered_map<std::string, xml_node> in_instanced;
        for (const xml_node& node : m_nodes)
            if (is_under(node, root))
                for (const char* word : { "id", "name" })
                    in_instanced.emplace(node.attribute(word).value(), node);
        NodeGraph<const pugi::xml_node_struct*> graph(m_limits);
        for (const xml_node& node : m_nodes)
            for (const xml_node& child : node)
                if (is(child, "node")) {
                    graph.add(node.internal_object(), child.internal_object());
                } else if (is(child, "instance_node")) {
                    const std::string name = target_of(child);
                    const auto in_library = m_library.find(name), elsewhere = in_instanced.find(name);
                    if (in_library != m_library.end())
                        graph.add(node.internal_object(), in_library->second.internal_object());
                    else if (elsewhere != in_instanced.end())
                        graph.add(node.internal_object(), elsewhere->second.internal_object());
                }
        return graph.error(root.internal_object(), [&](const pugi::xml_node_struct* node) {
            for (const xml_node& known : m_nodes)
                if (known.internal_object() == node)
                    return format("\"{}\"", known.attribute("id").value());
            return std::string();
        });
    }

private:
    // Call it for parents before their children.
    bool is_under(const xml_node& node, const xml_node& root)
    {
        const bool result = node == root || m_under.count(node.parent().internal_object()) > 0;
        if (result)
            m_under.insert(node.internal_object());
        return result;
    }

    const NodeLimits m_limits;
    bool m_is_too_deep = false;
    std::string m_instanced;
    std::vector<xml_node> m_nodes;
    std::unordered_map<std::string, xml_node> m_library;
    std::unordered_set<const pugi::xml_node_struct*> m_under;
};

} // namespace

bool is_collada(const FileHead& head)
{
    FileHead narrow = head; // of 16-bit text, every other byte
    narrow.bytes.erase(std::remove(narrow.bytes.begin(), narrow.bytes.end(), '\0'), narrow.bytes.end());
    OIIO::string_view text = first_text(narrow);
    for (const char* byte_order_mark : { "\xff\xfe", "\xfe\xff" })
        OIIO::Strutil::parse_prefix(text, byte_order_mark);
    return OIIO::Strutil::starts_with(text, "<") && OIIO::Strutil::icontains(text, "<collada");
}

Inspection inspect_collada(const std::string& text, const NodeLimits& limits)
{
    Inspection result;
    pugi::xml_document document;
    document.load_buffer(text.data(), text.size()); // of invalid XML, all before the error
    NodeCollector nodes(limits);
    document.traverse(nodes);
    result.error = nodes.is_too_deep() ? format("XML elements are nested more than {} deep", limits.depth)
                                       : nodes.hierarchy_error();
    return result;
}

} // namespace vmlight
