// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vmlight/base/stopwatch.h>

#include <algorithm>

namespace vmlight::cost {

/// Set `seconds` to the minimum run time of `work`. Short work is repeated, since other load only ever adds time.
/// Returns false as soon as `work` does.
template <class Work> bool min_seconds(double& seconds, Work&& work)
{
    constexpr double kEnoughSeconds = 0.02;
    constexpr int kMaxRuns = 8;
    const vmlight::Stopwatch all;
    for (int i = 0; i < kMaxRuns && (i == 0 || all() < kEnoughSeconds); ++i) {
        const vmlight::Stopwatch timer;
        if (!work())
            return false;
        seconds = i == 0 ? timer() : std::min(seconds, timer());
    }
    return true;
}

} // namespace vmlight::cost
