// SPDX-License-Identifier: Apache-2.0
/// What vmcost makes of its rows: means, front, knee, choice, and the tables.
#include <vmcost/models.h>
#include <vmcost/number_text.h>
#include <vmcost/report.h>
#include <vmcost/summary.h>
#include <vmcost/sweep.h>
#include <vmcost/tables.h>

#include <gtest/gtest.h>

#include <clocale>

using namespace vmlight::cost;

namespace {

Point point(double seconds, double rmse, int samples = 128, const char* model = "paper")
{
    Point made;
    made.setting = default_setting(model);
    made.setting.samples = samples;
    made.bake = seconds;
    made.rmse = rmse;
    return made;
}

std::vector<double> errors(const std::vector<Point>& points)
{
    std::vector<double> found;
    for (const Point& at : points)
        found.push_back(at.rmse);
    return found;
}

Row row(const std::string& environment, const Setting& setting, double rmse, double bias)
{
    Row made;
    made.environment = environment;
    made.setting = setting;
    made.errors.rmse = { rmse, rmse - 0.01, rmse + 0.03 };
    made.errors.bias = { bias, bias - 0.1, bias + 0.1 };
    made.bake = 2;
    made.light = rmse;
    made.shade = 0.25;
    return made;
}

} // namespace

TEST(CostSummary, TheFrontIsWhatNothingBeatsInBothTimeAndError)
{
    const std::vector<Point> points { point(3, 0.1), point(1, 0.5), point(2, 0.6), point(2, 0.3),
                                      point(4, 0.1), point(1, 0.7), point(5, 0.05) };
    EXPECT_EQ(errors(pareto_front(points)), (std::vector<double> { 0.5, 0.3, 0.1, 0.05 }));
    EXPECT_TRUE(pareto_front({}).empty());
}

TEST(CostSummary, TheKneeIsWhereMoreRaysGainLessThanTwoPercent)
{
    EXPECT_EQ(knee({ point(1, 0.5, 16), point(1, 0.41, 32), point(1, 0.4, 64), point(1, 0.4, 128) }).setting.samples,
              64);
    EXPECT_EQ(knee({ point(1, 0.5, 16), point(1, 0.407, 32), point(1, 0.4, 64) }).setting.samples, 32);
    EXPECT_EQ(knee({ point(1, 0.5, 16), point(1, 0.3, 32), point(1, 0.2, 64) }).setting.samples, 64);
    EXPECT_EQ(knee({ point(1, 0.4, 16), point(1, 0.5, 32) }).setting.samples, 16) << "worse later is no gain";
    EXPECT_EQ(knee({ point(1, 0, 16), point(1, 0, 32) }).setting.samples, 16);
}

TEST(CostSummary, TheChoiceIsTheCheapestThatReachesTheTarget)
{
    const std::vector<Point> points { point(3, 0.04), point(2, 0.05), point(1, 0.2), point(4, 0.01) };
    EXPECT_EQ(cheapest(points, 0.05)->rmse, 0.05);
    EXPECT_EQ(cheapest(points, 0.049)->rmse, 0.04);
    EXPECT_EQ(cheapest(points, 0.001), nullptr);
    EXPECT_EQ(nearest(points)->rmse, 0.01);
    EXPECT_EQ(nearest({ point(4, 0.01), point(1, 0.0102), point(0.5, 0.0103) })->rmse, 0.0102) << "what 2 % more buys";
    EXPECT_EQ(nearest({}), nullptr);
}

TEST(CostSummary, AnErrorWithinTheNoiseReachesNothingYet)
{
    std::vector<Point> points { point(1, 0), point(2, 0.04), point(3, 0.03) };
    points[0].rmse_half = 0.06;
    points[1].rmse_half = 0.02;
    points[2].rmse_half = 0.02;
    EXPECT_EQ(cheapest(points, 0.05)->rmse, 0.03);
    EXPECT_EQ(cheapest(points, 0.06)->rmse, 0);
    EXPECT_EQ(cheapest(points, 0.01), nullptr);
    EXPECT_TRUE(could_reach(points, 0.01));
    EXPECT_EQ(choice_text(points, 0.01),
              "1.0 %: the reference is too noisy to tell; nearest paper, 128 rays, 3.0 % in 3.0 s");
    points[0].rmse = 0.02;
    EXPECT_FALSE(could_reach(points, 0.01));
    EXPECT_EQ(choice_text(points, 0.01), "1.0 %: not reached by any model; nearest paper, 128 rays, 3.0 % in 3.0 s");
    EXPECT_EQ(choice_text(points, 0.05), "5.0 %: paper, 128 rays, 3.0 % in 3.0 s");
    EXPECT_NE(report_html({ "", points, {}, {}, {} }).find("no model reaches it; nearest:"), std::string::npos);
    points[0].rmse = 0;
    EXPECT_NE(report_html({ "", points, {}, {}, {} }).find("too noisy to tell; nearest:"), std::string::npos);
}

TEST(CostSummary, PointsAreMeansOverEnvironments)
{
    const Setting paper = default_setting("paper"), lobe = default_setting("lobe");
    const auto points = summarize({ row("a", paper, 0.2, 0.1), row("a", lobe, 0.1, 0), row("b", paper, 0.4, -0.3) });
    ASSERT_EQ(points.size(), 2u);
    EXPECT_DOUBLE_EQ(points[0].rmse, 0.3);
    EXPECT_DOUBLE_EQ(points[0].worst, 0.4);
    EXPECT_DOUBLE_EQ(points[0].rmse_half, 0.03) << "the longer half";
    EXPECT_DOUBLE_EQ(points[0].bias, -0.1);
    EXPECT_DOUBLE_EQ(points[0].total(), 2.55);
    EXPECT_EQ(points[1].setting.model, "lobe");
}

TEST(CostSummary, ACurveHoldsOneModelAndDiffersInSamplesAlone)
{
    std::vector<Point> points { point(1, 1, 64), point(1, 2, 16), point(1, 3, 32, "lobe"), point(1, 4, 32) };
    points[3].setting.storage = "half";
    EXPECT_EQ(errors(curve(points, "paper")), (std::vector<double> { 2, 1 }));
}

TEST(CostSummary, TheSweepIsAllSamplesOfAllModelsAndEachOtherAxisAlone)
{
    for (const bool quick : { true, false }) {
        const std::vector<Setting> settings = sweep(quick);
        for (size_t i = 0; i < settings.size(); ++i)
            for (size_t k = 0; k < i; ++k)
                EXPECT_FALSE(settings[i] == settings[k]) << settings[i].model << settings[i].samples;
        for (const ModelVariant& model : model_variants()) {
            int others = 0, here = 0;
            for (const Setting& setting : settings) {
                const Setting middle = default_setting(model.name);
                if (setting.model != model.name)
                    continue;
                const int off = (setting.samples != middle.samples) + (setting.cfem_width != middle.cfem_width)
                    + (setting.storage != middle.storage) + (setting.divisor != middle.divisor);
                EXPECT_LE(off, 1);
                here += off == 0;
                others += off == 1 && setting.samples == middle.samples;
            }
            EXPECT_EQ(here, 1) << model.name;
            EXPECT_EQ(others, (quick ? 2 : 6) + (model.half_bytes() > 0)) << model.name;
        }
    }
}

TEST(CostTables, TextsThatHoldCommasOrQuotesAreQuoted)
{
    const std::string csv = csv_text({ row("a, \"b\"", default_setting("paper"), 0.25, 0) });
    EXPECT_EQ(csv.substr(0, csv.find('\n')),
              "environment,model,samples,cfem_width,storage,divisor,bytes,bake_seconds,light_seconds,shade_seconds,"
              "rmse,rmse_low,rmse_high,bias,bias_low,bias_high,p95");
    EXPECT_NE(csv.find("\n\"a, \"\"b\"\"\",paper,128,128,float,1,0,2,0.25,0.25,0.25,0.24,0.28,0,-0.1,0.1,0\n"),
              std::string::npos)
        << csv;
}

TEST(CostTables, JsonHoldsWhatCsvHolds)
{
    const std::string json = json_text({ row("a\"\xff", default_setting("traced"), 0.25, 0) }, { { "mesh", "x.obj" } });
    EXPECT_NE(json.find("\"mesh\": \"x.obj\""), std::string::npos) << json;
    EXPECT_NE(json.find("\"rmse\": 0.25"), std::string::npos) << json;
    EXPECT_NE(json.find("\"storage\": \"\""), std::string::npos) << json;
}

TEST(CostWords, NumbersHaveThreeDigitsAndTheirUnit)
{
    EXPECT_EQ(percent_text(0.01), "1.0 %");
    EXPECT_EQ(percent_text(0.00987), "0.99 %");
    EXPECT_EQ(percent_text(-0.1234), "-12.3 %");
    EXPECT_EQ(percent_text(1.5), "150 %");
    EXPECT_EQ(seconds_text(0.00023), "0.23 ms");
    EXPECT_EQ(seconds_text(0.0123), "12 ms");
    EXPECT_EQ(seconds_text(1.25), "1.2 s");
    EXPECT_EQ(seconds_text(720), "12 min");
    EXPECT_EQ(escaped("<a & \"b\">"), "&lt;a &amp; &quot;b&quot;&gt;");
}
