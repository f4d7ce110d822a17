// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <string>
#include <unordered_map>
#include <vector>

namespace vmlight {

/// Which nodes of a mesh file are under which, as the file says it. Importers put a node that is under several into the
/// place of each, by recursion: a short file may be more than any memory holds, or have no end.
template <class Node> class MeshNodeGraph
{
public:
    /// @param most     nodes, each counted as often as it is put; assimp takes more than a kilobyte for each
    /// @param deepest  twice the default fits the stack that meshes are read on
    explicit MeshNodeGraph(size_t most = 1000000, int deepest = 100000)
        : m_most(most)
        , m_deepest(deepest)
    {
    }

    void add(const Node& parent, const Node& child) { m_children[parent].push_back(child); }

    /// Why the nodes under `root` must not be given to an importer, or "": one is under itself, they are too many or
    /// too deep. Its own recursion goes as deep: see on_deep_stack().
    /// @param name     of a node, as the user knows it
    template <class Name> std::string fault(const Node& root, const Name& name)
    {
        m_counts.clear();
        m_fault.clear();
        const size_t count = count_under(root, 0, name);
        if (m_fault.empty() && count > m_most)
            m_fault = "its nodes, each put where others name it, are more than " + std::to_string(m_most);
        return m_fault;
    }

private:
    template <class Name> size_t count_under(const Node& node, int depth, const Name& name)
    {
        constexpr size_t kUnderWay = 0;
        const auto [known, is_new] = m_counts.emplace(node, kUnderWay);
        if (!is_new && known->second == kUnderWay)
            m_fault = "its node " + name(node) + " is under itself";
        else if (depth > m_deepest)
            m_fault = "its nodes are more than " + std::to_string(m_deepest) + " deep";
        if (!is_new || !m_fault.empty())
            return known->second;
        size_t sum = 1;
        const auto children = m_children.find(node);
        if (children != m_children.end())
            for (const Node& child : children->second) {
                const size_t count = count_under(child, depth + 1, name);
                if (!m_fault.empty())
                    return sum;
                sum = sum + count > m_most ? m_most + 1 : sum + count;
            }
        m_counts[node] = sum; // others have come since: what `known` was is elsewhere now
        return sum;
    }

    size_t m_most;
    int m_deepest;
    std::unordered_map<Node, std::vector<Node>> m_children;
    std::unordered_map<Node, size_t> m_counts;
    std::string m_fault;
};

} // namespace vmlight
