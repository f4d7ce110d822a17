// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vmlight/base/stopwatch.h>

#include <algorithm>
#include <vector>

namespace vmlight::cost {

struct Timing
{
    /// Minimum over the runs: other load only ever adds time.
    double seconds = 0;
    /// By how much the median run took longer than the shortest, as a fraction of it; 0 for fewer than three runs.
    double spread = 0;
};

/// The Timing of runs of this many seconds. There must be one.
inline Timing timing_of(std::vector<double> runs)
{
    std::sort(runs.begin(), runs.end());
    return { runs[0], runs.size() < 3 ? 0 : runs[runs.size() / 2] / runs[0] - 1 };
}

/// Run `work`, repeatedly if it is short. Returns false as soon as `work` does.
template <class Work> bool measure_time(Timing& dst, Work&& work)
{
    constexpr double kEnoughSeconds = 0.02;
    constexpr size_t kMaxRuns = 8;
    const Stopwatch all;
    std::vector<double> runs;
    while (runs.empty() || (runs.size() < kMaxRuns && all() < kEnoughSeconds)) {
        const Stopwatch one;
        if (!work())
            return false;
        runs.push_back(one());
    }
    dst = timing_of(std::move(runs));
    return true;
}

} // namespace vmlight::cost
