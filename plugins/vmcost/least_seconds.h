// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <OpenImageIO/timer.h>

#include <algorithm>

namespace vmlight::cost {

/// The least time that `work` takes: what is short is done again, since other work of the machine only ever adds. False
/// as soon as `work` returns false.
template <class Work> bool least_seconds(double& seconds, Work&& work)
{
    constexpr double kEnough = 0.02;
    constexpr int kMostTimes = 8;
    const OIIO::Timer all;
    for (int i = 0; i < kMostTimes && (i == 0 || all() < kEnough); ++i) {
        const OIIO::Timer timer;
        if (!work())
            return false;
        seconds = i == 0 ? timer() : std::min(seconds, timer());
    }
    return true;
}

} // namespace vmlight::cost
