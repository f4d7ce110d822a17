// SPDX-License-Identifier: Apache-2.0
/// Loops over many small elements, in parallel.
#pragma once

#include <vmlight/base/parallel.h>

#include <algorithm>
#include <cstddef>

namespace vmlight {

/// So many elements are worth the time that a thread takes to start.
constexpr size_t kElementsOfBlock = size_t(1) << 16;

/// Blocks that parallel_blocks() makes of `count` elements.
inline size_t block_count(size_t count)
{
    return (count + kElementsOfBlock - 1) / kElementsOfBlock;
}

/// Call `work(begin, end, block)` for each block of consecutive elements, on OIIO's default number of threads. Blocks
/// depend on the count alone. Up to one block runs on the calling thread.
template <class Work> void parallel_blocks(size_t count, const Work& work)
{
    parallel_items(int64_t(block_count(count)), block_count(count) > 1 ? 0 : 1, [&](int64_t block, int) {
        const size_t begin = size_t(block) * kElementsOfBlock;
        work(begin, std::min(count, begin + kElementsOfBlock), size_t(block));
    });
}

} // namespace vmlight
