// SPDX-License-Identifier: Apache-2.0
/// What vmcost makes of its rows: means, front, knee, choice, and the tables.
#include <vmcost/commands.h>
#include <vmcost/models.h>
#include <vmcost/number_text.h>
#include <vmcost/report.h>
#include <vmcost/summary.h>
#include <vmcost/sweep.h>
#include <vmcost/tables.h>
#include <vmcost/timing.h>

#include <gtest/gtest.h>

#include <clocale>

using namespace vmlight::cost;

namespace {

Point point(double seconds, double rmse, int samples = 64, const char* model = "paper")
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

CommandInputs inputs_of(const std::string& mesh, const std::string& environment)
{
    CommandInputs inputs;
    inputs.mesh.mesh = mesh;
    inputs.environment = environment;
    return inputs;
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
}

TEST(CostSummary, GoalsAreTheLeastThatAPointReachesAndTheNextTwo)
{
    EXPECT_EQ(goals({ point(3, 0.04), point(1, 0.2) }), (std::vector<double> { 0.05, 0.07, 0.1 }));
    EXPECT_EQ(goals({ point(3, 0.05) }), (std::vector<double> { 0.05, 0.07, 0.1 }));
    EXPECT_EQ(goals({ point(3, 0) }), (std::vector<double> { 0.005, 0.01, 0.02 }));
    EXPECT_EQ(goals({ point(3, 0.6) }), (std::vector<double> { 0.7, 1 }));
    EXPECT_TRUE(goals({ point(3, 1.1) }).empty());
    EXPECT_TRUE(goals({}).empty());
}

TEST(CostSummary, AGoalIsSaidWithItsSettingAndItsCommand)
{
    const CommandInputs inputs = inputs_of("hero.obj", "sky.hdr");
    const std::vector<std::string> lines = choice_lines({ point(3, 0.08), point(1, 0.09), point(0.5, 0.12) }, inputs);
    ASSERT_EQ(lines.size(), 6u);
    EXPECT_EQ(lines[0], "10.0 %: paper, 64 rays, 9.0 % in 1.0 s");
    EXPECT_EQ(lines[1], "  " + command_text(default_setting("paper"), inputs));
    EXPECT_EQ(lines[2], "15.0 %: paper, 64 rays, 12.0 % in 500 ms");
    EXPECT_EQ(choice_lines({ point(3, 1.2) }, inputs)[0], "nearest: paper, 64 rays, 120 % in 3.0 s");
    EXPECT_TRUE(choice_lines({ point(3, 0.1, 64, kTraced) }, inputs).empty());
}

TEST(CostSummary, TimingsThatVaryAreSaidToBeUncertain)
{
    EXPECT_DOUBLE_EQ(timing_of({ 3, 1, 2 }).seconds, 1);
    EXPECT_DOUBLE_EQ(timing_of({ 3, 1, 2 }).spread, 1);
    EXPECT_DOUBLE_EQ(timing_of({ 2, 1 }).spread, 0) << "too few to tell";
    std::vector<Row> rows(3);
    EXPECT_EQ(typical_spread(rows), 0);
    rows[0].spread = 0.5;
    rows[2].spread = 0.3;
    EXPECT_DOUBLE_EQ(typical_spread(rows), 0.5);
    EXPECT_EQ(busy_note(kBusySpread), "");
    EXPECT_NE(busy_note(0.5).find("took 50.0 % longer than the shortest"), std::string::npos) << busy_note(0.5);
    Report report;
    EXPECT_EQ(report_html(report).find("class=busy"), std::string::npos);
    report.spread = 0.5;
    EXPECT_NE(report_html(report).find("class=busy"), std::string::npos);
}

TEST(CostCommands, HoldWhatTheSettingChanges)
{
    CommandInputs inputs = inputs_of("a b/hero's.obj", "sky.hdr");
    EXPECT_EQ(command_text(default_setting("paper"), inputs),
              "makevismap 'a b/hero'\\''s.obj' -o 'hero'\\''s_vismap.exr' && makelightmap 'hero'\\''s_vismap.exr' "
              "sky.hdr --model paper -o 'hero'\\''s_sky.exr'");
    inputs = inputs_of("hero.obj", "sky.hdr");
    inputs.mesh.mesh_params.normals = "flat";
    inputs.mesh.occluder = { "ground.obj", "wall.obj" };
    inputs.light.colorspace = "ACES - ACEScg";
    inputs.light.layer = "View.Combined";
    inputs.light.layout = "latlong";
    inputs.sanitize = true;
    Setting setting = default_setting("sh4");
    setting.samples = 512;
    setting.cfem_width = 64;
    setting.storage = "half";
    setting.divisor = 2;
    EXPECT_EQ(command_text(setting, inputs),
              "makevismap hero.obj --normals flat --resolution 512x512 --samples 512 --basis sh --order 4 --occluder "
              "ground.obj --occluder wall.obj --format half -o hero_vismap.exr && makelightmap hero_vismap.exr sky.hdr "
              "--model sh --cfem-resolution 64x32 --cfem-sanitize --colorspace 'ACES - ACEScg' --layer View.Combined "
              "--layout latlong -o hero_sky.exr");
    EXPECT_EQ(command_text(default_setting(kTraced), inputs), "");
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
              "shade_spread,rmse,rmse_low,rmse_high,rmse_by_visibility,bias,bias_low,bias_high,p95");
    EXPECT_NE(csv.find("\n\"a, \"\"b\"\"\",paper,64,128,float,1,0,2,0.25,0.25,0,0.25,0.24,0.28,0,0,-0.1,0.1,0\n"),
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
