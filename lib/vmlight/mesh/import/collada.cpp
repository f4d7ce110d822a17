// SPDX-License-Identifier: Apache-2.0
#include <vmlight/mesh/import/collada.h>

#include <vmlight/mesh/import/node_graph.h>

#include <OpenImageIO/strutil.h>

#include <pugixml.hpp>

#include <cstring>
#include <string>
#include <unordered_map>
#include <unordered_set>
#include <vector>

namespace vmlight {
namespace {

using OIIO::Strutil::fmt::format;
using pugi::xml_node;

constexpr int kDeepest = 100000; // twice as deep fits the stack that meshes are read on

bool is(const xml_node& element, const char* name)
{
    return std::strcmp(element.name(), name) == 0;
}

// What a url names; "" too is a name, of what has none.
std::string named_by(const xml_node& element)
{
    const char* url = element.attribute("url").value();
    return url[0] == '#' ? url + 1 : url;
}

// The nodes, as assimp finds them: in its library, which holds nodes that are under no other and whole scenes, the last
// of each id; else in the scene that is shown, the first of that id or name.
class Nodes : public pugi::xml_tree_walker
{
public:
    bool is_too_deep() const { return m_is_too_deep; }

    bool for_each(xml_node& element) override
    {
        m_is_too_deep |= depth() >= kDeepest;
        const bool is_scene = is(element, "visual_scene");
        if (is_scene || (is(element, "node") && is(element.parent(), "library_nodes")))
            m_library[element.attribute("id").value()] = element;
        if (is(element, "instance_visual_scene"))
            m_shown = named_by(element);
        if (is_scene || is(element, "node"))
            m_nodes.push_back(element);
        return !m_is_too_deep;
    }

    std::string fault()
    {
        const auto shown = m_library.find(m_shown);
        if (shown == m_library.end())
            return "";
        const xml_node root = shown->second;
        std::unordered_map<std::string, xml_node> in_scene;
        for (const xml_node& node : m_nodes)
            if (is_under(node, root))
                for (const char* word : { "id", "name" })
                    in_scene.emplace(node.attribute(word).value(), node);
        MeshNodeGraph<const pugi::xml_node_struct*> graph;
        for (const xml_node& node : m_nodes)
            for (const xml_node& child : node)
                if (is(child, "node")) {
                    graph.add(node.internal_object(), child.internal_object());
                } else if (is(child, "instance_node")) {
                    const std::string name = named_by(child);
                    const auto in_library = m_library.find(name), elsewhere = in_scene.find(name);
                    if (in_library != m_library.end())
                        graph.add(node.internal_object(), in_library->second.internal_object());
                    else if (elsewhere != in_scene.end())
                        graph.add(node.internal_object(), elsewhere->second.internal_object());
                }
        return graph.fault(root.internal_object(), [&](const pugi::xml_node_struct* node) {
            for (const xml_node& known : m_nodes)
                if (known.internal_object() == node)
                    return format("\"{}\"", known.attribute("id").value());
            return std::string();
        });
    }

private:
    // The walk goes from above to below: what is above has been asked about.
    bool is_under(const xml_node& node, const xml_node& root)
    {
        const bool result = node == root || m_under.count(node.parent().internal_object()) > 0;
        if (result)
            m_under.insert(node.internal_object());
        return result;
    }

    bool m_is_too_deep = false;
    std::string m_shown;
    std::vector<xml_node> m_nodes;
    std::unordered_map<std::string, xml_node> m_library;
    std::unordered_set<const pugi::xml_node_struct*> m_under;
};

} // namespace

std::string collada_fault(const std::string& text)
{
    pugi::xml_document document;
    document.load_buffer(text.data(), text.size()); // of broken XML, as much as there is before the break
    Nodes nodes;
    document.traverse(nodes);
    return nodes.is_too_deep() ? format("its elements are more than {} deep", kDeepest) : nodes.fault();
}

} // namespace vmlight
