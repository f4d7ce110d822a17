// SPDX-License-Identifier: Apache-2.0
// Nodes that no importer could expand: rings, doublings, chains.
#include <vmlight/mesh/import/node_graph.h>

#include <gtest/gtest.h>

using namespace vmlight;

namespace {

std::string numbered_node(int node)
{
    return std::to_string(node);
}

// Nodes 0 to `count`, each `times` under the one before.
NodeGraph<int> chain(int count, int times, const NodeLimits& limits = {})
{
    NodeGraph<int> graph(limits);
    for (int node = 0; node < count; ++node)
        for (int time = 0; time < times; ++time)
            graph.add(node, node + 1);
    return graph;
}

} // namespace

TEST(NodeGraph, ANodeIsNotItsOwnAncestor)
{
    NodeGraph<int> ring = chain(3, 1);
    EXPECT_EQ(ring.error(0, numbered_node), "");
    ring.add(3, 1);
    EXPECT_EQ(ring.error(0, numbered_node), "node 1 is its own ancestor");
    NodeGraph<int> itself;
    itself.add(0, 0);
    EXPECT_EQ(itself.error(0, numbered_node), "node 0 is its own ancestor");
    ring.add(7, 8);
    EXPECT_EQ(ring.error(7, numbered_node), "") << "a ring elsewhere";
}

TEST(NodeGraph, CopiesAreCounted)
{
    EXPECT_EQ(chain(4, 2, { 31, 10 }).error(0, numbered_node), "") << "1 + 2 + 4 + 8 + 16";
    EXPECT_EQ(chain(4, 2, { 30, 10 }).error(0, numbered_node), "node instances expand to more than 30 nodes");
    EXPECT_EQ(chain(200, 2).error(0, numbered_node), "node instances expand to more than 1000000 nodes")
        << "2^200 of them";
}

TEST(NodeGraph, DepthIsLimited)
{
    EXPECT_EQ(chain(10, 1, { 100, 10 }).error(0, numbered_node), "");
    EXPECT_EQ(chain(11, 1, { 100, 10 }).error(0, numbered_node), "nodes are nested more than 10 deep");
}
