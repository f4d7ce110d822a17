// SPDX-License-Identifier: Apache-2.0
#include "hard_case.h"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include <cstdlib>
#include <fstream>

namespace vmlight {

// Into the folder VMLIGHT_HARD_ROWS, where there is one.
void HardCase::write() const
{
    const char* folder = std::getenv("VMLIGHT_HARD_ROWS");
    if (testing::Test::HasFailure() || testing::Test::IsSkipped())
        return;
    EXPECT_FALSE(m_naive.empty() || m_ours.empty()) << "a row without a result";
    if (!folder)
        return;
    const auto& test = *testing::UnitTest::GetInstance()->current_test_info();
    const nlohmann::json row { { "family", test.test_suite_name() },
                               { "test", test.name() },
                               { "case", m_what },
                               { "naive", m_naive },
                               { "ours", m_ours },
                               { "peers", m_peers } };
    std::ofstream(std::string(folder) + "/" + test.test_suite_name() + "." + test.name() + ".json") << row;
}

} // namespace vmlight
