// SPDX-License-Identifier: Apache-2.0
// vmcost's report: its tables agree, and its page fetches nothing.
#include "cost_run.h"

#include <OpenImageIO/strutil.h>

using namespace vmlight;
using OIIO::Strutil::splits;
using testing::Each;
using testing::HasSubstr;
using testing::MatchesRegex;
using testing::Not;
using testing::StartsWith;

namespace {

using CostReport = CostTest;

} // namespace

TEST_F(CostReport, TheReportShowsItsTablesAndFetchesNothing)
{
    if (std::system("gnuplot --version >/dev/null 2>&1") != 0)
        GTEST_SKIP() << "gnuplot is not installed";
    const std::string printed = cost("sky.exr checker.exr" + small_with_plots);
    const auto rows = ordered_rows();
    expect_counts(int(rows.size()), 0);

    std::vector<std::string> table = splits(read("report/costs.csv"), "\n");
    if (!table.empty() && table.back().empty())
        table.pop_back();
    ASSERT_EQ(table.size(), rows.size() + 1);
    for (std::string& line : table)
        line = OIIO::Strutil::replace(line, "\r", "");
    const std::vector<std::string> columns = splits(table[0], ",");
    for (size_t i = 0; i < rows.size(); ++i) {
        const std::vector<std::string> cells = splits(table[i + 1], ",");
        ASSERT_EQ(cells.size(), rows[i].size());
        size_t column = 0;
        for (const auto& [name, value] : rows[i].items()) {
            EXPECT_EQ(columns[column], name);
            const std::string& cell = cells[column++];
            if (value.is_number_float())
                EXPECT_NEAR(std::stod(cell), double(value), 1e-5 * std::abs(double(value))) << name;
            else
                EXPECT_EQ(cell, value.is_string() ? std::string(value) : value.dump()) << name;
        }
        EXPECT_LE(double(rows[i]["rmse_low"]), double(rows[i]["rmse"]));
        EXPECT_LE(double(rows[i]["rmse"]), double(rows[i]["rmse_high"]));
        EXPECT_GT(double(rows[i]["shade_seconds"]), 0);
    }
    EXPECT_EQ(values("environment"), (std::set<std::string> { "sky", "checker" }));

    std::string page = read("report/report.html");
    // The live view, whose own test says that it fetches nothing.
    const size_t live = page.find(" srcdoc=\""), end = page.find("\"></iframe>", live);
    ASSERT_LT(end, page.size());
    EXPECT_THAT(page.substr(live, 100), HasSubstr("&lt;!DOCTYPE html"));
    page.erase(live, end - live);
    EXPECT_THAT(page, StartsWith("<!DOCTYPE html>"));
    EXPECT_EQ(count(page, "<svg"), 3u);
    EXPECT_EQ(count(page, "data:image/png;base64,"), 2 * values("model").size());
    for (const std::string start : { "src=", "href=" })
        for (size_t at = page.find(start); at != std::string::npos; at = page.find(start, at + 1)) {
            const std::string target = page.substr(page.find_first_not_of("\"'", at + start.size()), 5);
            EXPECT_TRUE(target == "data:" || target[0] == '#') << "is fetched: " << page.substr(at, 80);
        }
    EXPECT_THAT(page, Not(HasSubstr("@import")));
    EXPECT_THAT(printed, testing::ContainsRegex("\n[0-9.]+ %: [a-z0-9]+, [0-9]+ rays, "));
    for (const std::string name : { "error_time", "error_bytes", "error_rays" }) {
        EXPECT_EQ(read("report/" + name + ".png").substr(1, 3), "PNG");
        EXPECT_THAT(read("report/" + name + ".svg"), HasSubstr("<svg"));
    }
    EXPECT_GT(pixels("report/error_sky_lobe.exr").width, 0);
    EXPECT_GT(pixels("report/error_sky_lobe.png").width, 0);
    EXPECT_THAT(names("", "report"), Each(Not(StartsWith(".")))) << "debris";
}

// As it stands but for its size, to be quick.
TEST_F(CostReport, EachCommandOfTheReportRuns)
{
    cost("sky.exr" + small);
    const std::string page = read("report/report.html"), open = "<code>", close = "</code>";
    int commands = 0;
    for (size_t at = page.find(open); at != std::string::npos; at = page.find(open, at + 1), ++commands) {
        const size_t begin = at + open.size();
        std::string text = page.substr(begin, page.find(close, begin) - begin);
        text = OIIO::Strutil::replace(text, "&amp;", "&", true);
        const std::vector<std::string> lines = splits(text, " && ");
        ASSERT_EQ(lines.size(), 2u) << text;
        done(lines[0] + " --resolution 16");
        done(lines[1]);
        EXPECT_TRUE(exists("step_sky.exr"));
        remove("step_sky.exr");
    }
    EXPECT_GE(commands, 2);
}
