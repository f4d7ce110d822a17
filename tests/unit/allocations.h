// SPDX-License-Identifier: Apache-2.0
/// Counts large allocations, so that tests can check that what changes nothing holds no memory.
#pragma once

#include <cstdint>

namespace vmlight {

/// While it lives, counts allocations by `new` of at least 4 KiB, of all threads.
class LargeAllocations
{
public:
    LargeAllocations();
    ~LargeAllocations();
    LargeAllocations(const LargeAllocations&) = delete;
    LargeAllocations& operator=(const LargeAllocations&) = delete;

    /// 0 under sanitizers, whose own `new` is kept.
    int64_t count() const;
};

} // namespace vmlight
