// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vmlight/base/parallel_blocks.h>

#include <vector>

namespace vmlight {

/// The elements at `indices`, in their order; none if there are none to pick from.
template <class Element, class Index>
std::vector<Element> picked(const std::vector<Element>& from, const std::vector<Index>& indices)
{
    std::vector<Element> to(from.empty() ? 0 : indices.size());
    parallel_blocks(to.size(), [&](size_t begin, size_t end, size_t) {
        for (size_t i = begin; i < end; ++i)
            to[i] = from[indices[i]];
    });
    return to;
}

} // namespace vmlight
