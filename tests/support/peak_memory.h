// SPDX-License-Identifier: Apache-2.0
/// Memory that a test's program and its libraries ask for: not what the machine gives, which depends on what else it
/// does.
#pragma once

#include <cstdint>

namespace vmlight {

/// Counts what operator new gives and delete takes back, on all threads. peak_memory.cpp replaces both; sanitizers have
/// their own, and nothing is counted under them.
class PeakMemory
{
public:
    PeakMemory();
    /// The most that was held at once since it was made, beyond what was held then; 0 under sanitizers.
    int64_t bytes() const;

private:
    int64_t m_before;
};

} // namespace vmlight
