// SPDX-License-Identifier: Apache-2.0
/// Runs of vmcost on a small scene.
#pragma once

#include "command_test.h"

#include <OpenImageIO/imagebufalgo.h>

#include <nlohmann/json.hpp>

#include <algorithm>
#include <cstdio>
#include <set>
#include <string>

namespace vmlight {

class CostTest : public CommandTest
{
protected:
    const std::string small_with_plots = " --quick --resolution 16 --reference-samples 8",
                      small = small_with_plots + " --no-plots";
    int measured = -1, reused = -1; ///< rows of the last cost()

    void SetUp() override
    {
        // A floor with a wall on it, which casts.
        write("step.obj",
              "v -1 -1 0\nv 1 -1 0\nv 1 1 0\nv -1 1 0\nv 1 -1 1\nv 1 1 1\n"
              "vt 0 0\nvt 0.5 0\nvt 0.5 1\nvt 0 1\nvt 0.5 0\nvt 1 0\nvt 1 1\nvt 0.5 1\nvn 0 0 1\nvn -1 0 0\n"
              "f 1/1/1 2/2/1 3/3/1 4/4/1\nf 2/5/2 5/6/2 6/7/2 3/8/2\n");
        make_sky({ 1, 2, 3 });
        OIIO::ImageBuf checker(OIIO::ImageSpec(64, 32, 3, OIIO::TypeFloat));
        OIIO::ImageBufAlgo::checker(checker, 8, 4, 1, { 1.0f, 0.5f, 0.2f }, { 0.1f, 0.3f, 2.0f });
        EXPECT_TRUE(checker.write(path("checker.exr"))) << checker.geterror();
    }

    /// Measures step.obj under environments, with flags; returns what was printed.
    std::string cost(const std::string& words)
    {
        const std::string printed = done("vmcost step.obj " + words + " -o report");
        measured = reused = -1;
        const size_t at = std::min(printed.rfind("measured "), printed.size());
        EXPECT_EQ(std::sscanf(printed.c_str() + at, "measured %d row%*[s,] reused %d", &measured, &reused), 2)
            << printed;
        return printed;
    }
    void expect_counts(int measured_rows, int reused_rows, const std::string& why = "") const
    {
        EXPECT_EQ(std::pair(measured, reused), std::pair(measured_rows, reused_rows)) << why;
    }

    nlohmann::ordered_json ordered_rows() const
    {
        return nlohmann::ordered_json::parse(read("report/costs.json"))["rows"];
    }
    nlohmann::json rows() const { return nlohmann::json::parse(read("report/costs.json"))["rows"]; }
    std::set<std::string> values(const std::string& column) const
    {
        std::set<std::string> found;
        for (const auto& row : rows())
            found.insert(row[column]);
        return found;
    }
};

} // namespace vmlight
