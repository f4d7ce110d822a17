// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <string>
#include <unordered_map>
#include <vector>

namespace vmlight {

/// What importers can be given.
struct NodeLimits
{
    size_t nodes = 1000000; ///< after expansion; assimp needs more than a kilobyte for each
    int depth = 100000; ///< the deep stack that meshes are read on holds twice this
};

/// The parents and children that a mesh file declares. Importers copy a node with several parents under each of them,
/// by recursion: a short file may expand to more than memory holds, or never end.
template <class Node> class NodeGraph
{
public:
    explicit NodeGraph(const NodeLimits& limits = {})
        : m_limits(limits)
    {
    }

    void add(const Node& parent, const Node& child) { m_children[parent].push_back(child); }

    /// Why the nodes under `root` must not be given to an importer, or "": one is its own ancestor, or they are too
    /// many or too deep. Recurses as deep as they go: see run_on_deep_stack().
    /// @param name_of  a node, as the user knows it
    template <class NameOf> std::string error(const Node& root, const NameOf& name_of)
    {
        m_counts.clear();
        m_error.clear();
        const size_t count = count_under(root, 0, name_of);
        if (m_error.empty() && count > m_limits.nodes)
            m_error = "node instances expand to more than " + std::to_string(m_limits.nodes) + " nodes";
        return m_error;
    }

private:
    template <class NameOf> size_t count_under(const Node& node, int depth, const NameOf& name_of)
    {
        constexpr size_t kInProgress = 0;
        const auto [known, is_new] = m_counts.emplace(node, kInProgress);
        if (!is_new && known->second == kInProgress)
            m_error = "node " + name_of(node) + " is its own ancestor";
        else if (depth > m_limits.depth)
            m_error = "nodes are nested more than " + std::to_string(m_limits.depth) + " deep";
        if (!is_new || !m_error.empty())
            return known->second;
        size_t sum = 1;
        const auto children = m_children.find(node);
        if (children != m_children.end())
            for (const Node& child : children->second) {
                const size_t count = count_under(child, depth + 1, name_of);
                if (!m_error.empty())
                    return sum;
                sum = sum + count > m_limits.nodes ? m_limits.nodes + 1 : sum + count;
            }
        m_counts[node] = sum; // looked up again: `known` is invalid after insertions
        return sum;
    }

    NodeLimits m_limits;
    std::unordered_map<Node, std::vector<Node>> m_children;
    std::unordered_map<Node, size_t> m_counts;
    std::string m_error;
};

} // namespace vmlight
