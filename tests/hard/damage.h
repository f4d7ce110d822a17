// SPDX-License-Identifier: Apache-2.0
/// Damaged copies of a file, and a process to try them in.
#pragma once

#include <gtest/gtest.h>

#include <functional>
#include <random>
#include <string>
#include <vector>

#include <sys/mman.h>
#include <sys/wait.h>
#include <unistd.h>

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

/// Call `attempt` for each damage, in a process of its own: a crash, ten seconds for one of them, and what `attempt`
/// says went wrong are failures that name the damage.
///
/// @param attempt  returns "" if all is well
inline void survive(const std::vector<Damage>& damages, const std::function<std::string(const Damage&)>& attempt)
{
    struct Seen
    {
        size_t damage;
        char fault[512];
    };
    void* const memory = ::mmap(nullptr, sizeof(Seen), PROT_READ | PROT_WRITE, MAP_SHARED | MAP_ANONYMOUS, -1, 0);
    ASSERT_NE(memory, MAP_FAILED);
    Seen& seen = *static_cast<Seen*>(memory);
    const pid_t child = ::fork();
    if (child == 0) {
        for (; seen.damage < damages.size() && !seen.fault[0]; seen.damage += !seen.fault[0]) {
            ::alarm(10);
            const std::string fault = attempt(damages[seen.damage]);
            fault.copy(seen.fault, sizeof(seen.fault) - 1);
        }
        ::_exit(0);
    }
    int status = 0;
    EXPECT_EQ(::waitpid(child, &status, 0), child);
    const size_t at = std::min(seen.damage, damages.size() - 1);
    EXPECT_FALSE(WIFSIGNALED(status)) << damages[at].what << ": signal " << WTERMSIG(status);
    EXPECT_STREQ(seen.fault, "") << damages[at].what;
    EXPECT_EQ(WIFSIGNALED(status) || seen.fault[0] ? damages.size() : seen.damage, damages.size());
    ::munmap(memory, sizeof(Seen));
}

} // namespace vmlight
