// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vmlight/base/parallel_blocks.h>

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

namespace vmlight {

/// Disjoint sets of numbers, each identified by its least: in whatever order and by however many threads they are
/// joined, the result is the same. Source: R. Anderson, H. Woll, "Wait-free Parallel Algorithms for the Union-Find
/// Problem", STOC 1991; with path halving.
class DisjointSets
{
public:
    explicit DisjointSets(size_t count)
        : m_parent(count)
    {
        parallel_blocks(count, [&](size_t begin, size_t end, size_t) {
            for (size_t i = begin; i < end; ++i)
                m_parent[i].store(uint32_t(i), kAnyOrder);
        });
    }

    /// The least of the set that holds `i`. Thread-safe, but may be that of a part while others join.
    uint32_t find(uint32_t i)
    {
        for (;;) {
            uint32_t parent = m_parent[i].load(kAnyOrder);
            const uint32_t above = m_parent[parent].load(kAnyOrder);
            if (parent == above)
                return parent;
            m_parent[i].compare_exchange_weak(parent, above, kAnyOrder);
            i = above;
        }
    }

    /// Thread-safe.
    void join(uint32_t a, uint32_t b)
    {
        while ((a = find(a)) != (b = find(b))) {
            if (a < b)
                std::swap(a, b);
            uint32_t root = a; // until another thread joins it
            if (m_parent[a].compare_exchange_strong(root, b, kAnyOrder))
                return;
        }
    }

private:
    // A parent is always less than its child, and only ever replaced by a lesser one of the same set.
    static constexpr std::memory_order kAnyOrder = std::memory_order_relaxed;
    std::vector<std::atomic<uint32_t>> m_parent;
};

} // namespace vmlight
