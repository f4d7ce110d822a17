// SPDX-License-Identifier: Apache-2.0
/// Damaged copies of a file.
#pragma once

#include "peak_memory.h"
#include "watchdog.h"

#include <gtest/gtest.h>

#include <functional>
#include <random>
#include <string>
#include <vector>

namespace vmlight {

struct Damage
{
    std::string what, bytes;
};

/// `whole`, cut at 40 places from its start to its end, and with one bit turned over at each of 100 others.
inline std::vector<Damage> damages_of(const std::string& whole)
{
    constexpr size_t kCuts = 40, kFlips = 100;
    std::vector<Damage> all;
    for (size_t k = 0; k < kCuts; ++k)
        all.push_back(
            { "cut at " + std::to_string(whole.size() * k / kCuts), whole.substr(0, whole.size() * k / kCuts) });
    std::mt19937 random(7);
    for (size_t k = 0; k < kFlips; ++k) {
        const size_t bit = random() % (8 * whole.size());
        std::string flipped = whole;
        flipped[bit / 8] = char(flipped[bit / 8] ^ (1 << bit % 8));
        all.push_back({ "bit " + std::to_string(bit) + " of " + std::to_string(8 * whole.size()), flipped });
    }
    return all;
}

/// Call `attempt` for each damage: what `attempt` says went wrong is a failure that names the damage, and so is one
/// that takes 50 MB more than OpenImageIO takes for the scanlines of any image: 64 MiB, which it hardly touches. A
/// crash, or a damage that takes as long as a whole test may, ends the process, and the watchdog names test and damage.
///
/// @param attempt  returns "" if all is well
inline void survive(const std::vector<Damage>& damages, const std::function<std::string(const Damage&)>& attempt)
{
    for (const Damage& damage : damages) {
        set_current_case(damage.what);
        restart_watchdog();
        const PeakMemory memory;
        const std::string fault = attempt(damage);
        EXPECT_EQ(fault, "") << damage.what;
        EXPECT_LT(memory.bytes(), (64 + 50) << 20) << damage.what;
    }
    set_current_case("");
}

} // namespace vmlight
