// SPDX-License-Identifier: Apache-2.0
#include <vmlight/mesh/import/gltf/hierarchy.h>

#include <vmlight/base/format.h>
#include <vmlight/mesh/import/gltf/error.h>
#include <vmlight/mesh/import/node_graph.h>
#include <vmlight/mesh/tinygltf.h>

#include <Imath/ImathQuat.h>

#include <algorithm>

namespace vmlight::gltf {
namespace {

using Imath::M44d;

// The parent of each node, or -1.
std::vector<int> parents_of(const tinygltf::Model& model)
{
    std::vector<int> parents(model.nodes.size(), -1);
    for (size_t node = 0; node < model.nodes.size(); ++node)
        for (const int child : model.nodes[node].children) {
            if (child < 0 || size_t(child) >= parents.size())
                throw Error(
                    format("node {} has the child {}, but there are only {} nodes", node, child, parents.size()));
            if (parents[size_t(child)] != -1)
                throw Error(format("node {} has two parents: {} and {}", child, parents[size_t(child)], node));
            parents[size_t(child)] = int(node);
        }
    return parents;
}

M44d local_transform(const tinygltf::Node& node)
{
    // In the file's order, column by column, a matrix for columns is one for rows.
    if (node.matrix.size() == 16) {
        M44d matrix;
        std::copy(node.matrix.begin(), node.matrix.end(), &matrix[0][0]);
        return matrix;
    }
    M44d matrix;
    if (node.scale.size() == 3)
        matrix.setScale(Imath::V3d(node.scale[0], node.scale[1], node.scale[2]));
    if (node.rotation.size() == 4) {
        const auto& q = node.rotation; // x, y, z, w
        matrix *= Imath::Quatd(q[3], q[0], q[1], q[2]).normalized().toMatrix44();
    }
    if (node.translation.size() == 3)
        matrix *= M44d().setTranslation(Imath::V3d(node.translation[0], node.translation[1], node.translation[2]));
    return matrix;
}

} // namespace

bool is_nested_too_deep(const std::string& json)
{
    constexpr int kMaxDepth = 1000; // a glTF has about ten
    int depth = 0;
    bool in_string = false;
    for (size_t i = 0; i < json.size(); ++i) {
        const char c = json[i];
        if (in_string) {
            i += c == '\\';
            in_string = c != '"';
        } else if (c == '"') {
            in_string = true;
        } else if ((c == '{' || c == '[') && ++depth > kMaxDepth) {
            return true;
        } else if (c == '}' || c == ']') {
            --depth;
        }
    }
    return false;
}

std::vector<int> root_nodes(const tinygltf::Model& model)
{
    if (!model.scenes.empty()) {
        const int scene = std::max(model.defaultScene, 0);
        if (size_t(scene) >= model.scenes.size())
            throw Error(format("the default scene is {}, but there are only {}", scene, model.scenes.size()));
        return model.scenes[size_t(scene)].nodes;
    }
    std::vector<int> roots;
    const std::vector<int> parents = parents_of(model);
    for (size_t node = 0; node < parents.size(); ++node)
        if (parents[node] == -1)
            roots.push_back(int(node));
    return roots;
}

void check_hierarchy(const tinygltf::Model& model, const std::vector<int>& roots)
{
    parents_of(model);
    const size_t none = model.nodes.size();
    NodeGraph<size_t> graph;
    for (size_t node = 0; node < model.nodes.size(); ++node)
        for (const int child : model.nodes[node].children)
            graph.add(node, size_t(child));
    for (const int root : roots) {
        if (root < 0 || size_t(root) >= none)
            throw Error(format("the scene has node {}, but there are only {} nodes", root, none));
        graph.add(none, size_t(root)); // `none` is the scene
    }
    const std::string error = graph.error(none, [](size_t node) { return format("{}", node); });
    if (!error.empty())
        throw Error(error);
}

std::vector<M44d> node_transforms(const tinygltf::Model& model)
{
    const std::vector<int> parents = parents_of(model);
    std::vector<M44d> transforms(parents.size());
    std::vector<bool> is_done(parents.size(), false);
    std::vector<size_t> chain;
    for (size_t node = 0; node < parents.size(); ++node) {
        // A ring of nodes in no scene has passed the check: it ends where it started.
        for (int at = int(node); at != -1 && !is_done[size_t(at)] && chain.size() <= parents.size();
             at = parents[size_t(at)])
            chain.push_back(size_t(at));
        for (; !chain.empty(); chain.pop_back()) {
            const size_t at = chain.back();
            transforms[at] = local_transform(model.nodes[at]);
            if (parents[at] != -1)
                transforms[at] *= transforms[size_t(parents[at])];
            is_done[at] = true;
        }
    }
    return transforms;
}

bool is_node_visible(const tinygltf::Model& model, int node)
{
    const auto& extensions = model.nodes[size_t(node)].extensions;
    const auto visibility = extensions.find("KHR_node_visibility");
    if (visibility == extensions.end() || !visibility->second.Has("visible"))
        return true;
    const tinygltf::Value& visible = visibility->second.Get("visible");
    return !visible.IsBool() || visible.Get<bool>();
}

} // namespace vmlight::gltf
