// SPDX-License-Identifier: Apache-2.0
#include <vmlight/mesh_file_gltf.h>

#include <vmlight/mesh_node_graph.h>

#include <OpenImageIO/strutil.h>

#include <nlohmann/json.hpp>

#include <algorithm>
#include <utility>
#include <vector>

namespace vmlight {
namespace {

using nlohmann::json;
using OIIO::Strutil::fmt::format;

constexpr int kDeepest = 1000; // brackets; a glTF has about ten

// The JSON: all of a .gltf, the first chunk of a GLB. The importer stops at a zero, and takes any bytes in a string:
// what is not ASCII, which only strings hold, is made a question mark.
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

// The nodes that nodes and scenes name, collected as the JSON goes by. (A tree of all of it, with a callback that drops
// the rest, takes time by the square of the nodes in nlohmann 3.11.)
class NodeReader : public nlohmann::json_sax<json>
{
public:
    bool is_too_deep() const { return depth_ > kDeepest; }
    size_t node_count() const { return node_count_; }
    const std::vector<std::pair<size_t, size_t>>& parents_and_children() const { return parents_and_children_; }
    const std::vector<std::pair<size_t, size_t>>& scenes_and_roots() const { return scenes_and_roots_; }
    size_t scene() const { return scene_; }

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
        if (depth_ == 1)
            outer_ = name;
        else if (depth_ == 3)
            inner_ = name;
        return true;
    }

    bool number_unsigned(uint64_t number) override
    {
        if (depth_ == 1 && outer_ == "scene")
            scene_ = number;
        else if (depth_ == 4 && outer_ == "scenes" && inner_ == "nodes")
            scenes_and_roots_.emplace_back(scene_count_ - 1, number);
        else if (depth_ == 4 && outer_ == "nodes" && inner_ == "children")
            parents_and_children_.emplace_back(node_count_ - 1, number);
        return value();
    }

private:
    // Depths: 1 in the root, 2 in its "nodes" or "scenes", 3 in one, 4 in its "children" or "nodes".
    bool open()
    {
        value();
        return ++depth_ <= kDeepest;
    }

    bool close()
    {
        --depth_;
        return true;
    }

    bool value()
    {
        node_count_ += depth_ == 2 && outer_ == "nodes";
        scene_count_ += depth_ == 2 && outer_ == "scenes";
        return true;
    }

    int depth_ = 0;
    size_t node_count_ = 0, scene_count_ = 0, scene_ = 0;
    std::string outer_, inner_;
    std::vector<std::pair<size_t, size_t>> parents_and_children_, scenes_and_roots_;
};

} // namespace

std::string gltf_fault(const std::string& bytes)
{
    NodeReader nodes;
    const bool is_json = json::sax_parse(json_of(bytes), &nodes);
    if (nodes.is_too_deep())
        return format("its JSON has brackets more than {} deep", kDeepest);
    if (!is_json)
        return "";
    const size_t none = nodes.node_count();
    std::vector<size_t> parents(none, none);
    for (const auto& [parent, child] : nodes.parents_and_children()) {
        if (child >= none)
            continue;
        if (parents[child] != none)
            return format("its node {} is under two others: {} and {}", child, parents[child], parent);
        parents[child] = parent;
    }
    MeshNodeGraph<size_t> graph;
    for (const auto& [parent, child] : nodes.parents_and_children())
        graph.add(parent, child);
    for (const auto& [scene, root] : nodes.scenes_and_roots())
        if (scene == nodes.scene())
            graph.add(none, root); // `none` stands for the scene
    return graph.fault(none, [](size_t node) { return format("{}", node); });
}

} // namespace vmlight
