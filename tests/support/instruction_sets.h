// SPDX-License-Identifier: Apache-2.0
/// The instruction sets that Highway's kernels are compiled for, one after the other.
#pragma once

#include <gtest/gtest.h>
#include <hwy/highway.h>

#include <cstdint>

namespace vmlight {

/// Call `work` with the name of each instruction set that this machine has, while kernels run by it. Afterwards they
/// run by the best again. Expects that there is one. Returns how many there are.
template <class Work> int with_each_instruction_set(const Work& work)
{
    int tested = 0;
    for (int64_t target = 1; target; target = int64_t(uint64_t(target) << 1)) {
        hwy::SetSupportedTargetsForTest(0);
        if (!(hwy::SupportedTargets() & target))
            continue;
        ++tested;
        hwy::SetSupportedTargetsForTest(target);
        hwy::GetChosenTarget().Update(hwy::SupportedTargets());
        work(hwy::TargetName(target));
    }
    hwy::SetSupportedTargetsForTest(0);
    hwy::GetChosenTarget().Update(hwy::SupportedTargets());
    EXPECT_GT(tested, 0);
    return tested;
}

} // namespace vmlight
