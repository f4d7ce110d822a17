// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>

namespace vmlight {

/// Wall-clock time since it was made or last lapped, in seconds.
class Stopwatch
{
public:
    double operator()() const { return seconds(Clock::now() - m_start); }
    /// The same, and starts anew.
    double lap()
    {
        const Clock::time_point now = Clock::now(), start = m_start;
        m_start = now;
        return seconds(now - start);
    }

private:
    using Clock = std::chrono::steady_clock;
    static double seconds(Clock::duration time) { return std::chrono::duration<double>(time).count(); }

    Clock::time_point m_start = Clock::now();
};

} // namespace vmlight
