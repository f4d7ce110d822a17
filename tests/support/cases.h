// SPDX-License-Identifier: Apache-2.0
/// How many cases a test tries.
#pragma once

namespace vmlight {

/// Of cases that differ in their numbers alone, all; under sanitizers `fewer`: they look at memory and arithmetic,
/// which further cases do alike, and take a dozen times as long.
constexpr int cases([[maybe_unused]] int all, [[maybe_unused]] int fewer)
{
#ifdef VMLIGHT_SANITIZED
    return fewer;
#else
    return all;
#endif
}

} // namespace vmlight
