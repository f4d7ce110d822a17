// SPDX-License-Identifier: Apache-2.0
#include <vmlight/mesh_file_collada.h>

#include <OpenImageIO/strutil.h>

#include <pugixml.hpp>

#include <algorithm>
#include <cstring>
#include <map>
#include <string>
#include <vector>

namespace vmlight {
namespace {

using OIIO::Strutil::fmt::format;

constexpr int kDeepest = 100000; // twice as deep fits the stack that meshes are read on
constexpr size_t kMostNodes = 1000000; // the importer takes more than a kilobyte for each

bool is(const pugi::xml_node& element, const char* name)
{
    return std::strcmp(element.name(), name) == 0;
}

// What the nodes of the scenes are once the nodes that they name are put in their places. The importer knows a node by
// its id or its name.
class NodeCounter : public pugi::xml_tree_walker
{
public:
    bool for_each(pugi::xml_node& element) override
    {
        is_deep_ |= depth() >= kDeepest;
        if (!is(element, "node"))
            return !is_deep_;
        for (const char* name : { "id", "name" })
            if (const pugi::xml_attribute attribute = element.attribute(name))
                named_.emplace(attribute.value(), element);
        if (is(element.parent(), "visual_scene"))
            roots_.push_back(element);
        return true;
    }

    // Why there is no end of them, or "".
    std::string fault()
    {
        size_t sum = 0;
        for (size_t i = 0; i < roots_.size() && !is_deep_ && ring_.empty(); ++i)
            sum = std::min(kMostNodes + 1, sum + count(roots_[i], 1));
        if (is_deep_)
            return format("its elements are more than {} deep", kDeepest);
        if (!ring_.empty())
            return format("its node {} is under itself", ring_);
        return sum > kMostNodes ? format("its nodes name others until they are more than {}", kMostNodes) : "";
    }

private:
    // This node, those under it and those that it names, up to a node more than the most.
    size_t count(const pugi::xml_node& node, int depth)
    {
        constexpr size_t kUnderWay = 0;
        const auto [known, is_new] = counts_.emplace(node.internal_object(), kUnderWay);
        if (!is_new && known->second == kUnderWay)
            ring_ = node.attribute("id").value();
        is_deep_ |= depth > kDeepest;
        if (!is_new || is_deep_)
            return known->second;
        size_t sum = 1;
        const auto add = [&](const pugi::xml_node& other) {
            if (ring_.empty() && !is_deep_)
                sum = std::min(kMostNodes + 1, sum + count(other, depth + 1));
        };
        for (const pugi::xml_node child : node)
            if (is(child, "node"))
                add(child);
            else if (const char* url = child.attribute("url").value(); is(child, "instance_node") && url[0] == '#')
                for (auto [at, end] = named_.equal_range(url + 1); at != end; ++at)
                    add(at->second);
        return known->second = sum;
    }

    bool is_deep_ = false;
    std::string ring_;
    std::vector<pugi::xml_node> roots_;
    std::multimap<std::string, pugi::xml_node> named_;
    std::map<const pugi::xml_node_struct*, size_t> counts_;
};

} // namespace

std::string collada_fault(const std::string& text)
{
    pugi::xml_document document;
    document.load_buffer(text.data(), text.size()); // of broken XML, as much as there is before the break
    NodeCounter nodes;
    document.traverse(nodes);
    return nodes.fault();
}

} // namespace vmlight
