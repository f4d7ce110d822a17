// SPDX-License-Identifier: Apache-2.0
#include <vmlight/cli/progress_line.h>

#include <gtest/gtest.h>

using namespace vmlight;

TEST(ProgressLine, TellsShareRateAndTimeLeft)
{
    EXPECT_EQ(progress_line("bake", 0.25, 10, 1 << 20), "bake  25 %  26.2 k texels/s  00:30 left");
    EXPECT_EQ(progress_line("bake", 1, 10.5, 1 << 20), "bake 100 %  99.9 k texels/s  00:11");
    EXPECT_EQ(progress_line("light", 0.5, 0.01, 1 << 24), "light  50 %  839 M texels/s  00:01 left");
}

TEST(ProgressLine, BeforeTheFirstNewsTheTimeIsNotKnown)
{
    EXPECT_EQ(progress_line("bake", 0, 0, 100), "bake   0 %  0 texels/s  --:-- left");
    EXPECT_EQ(progress_line("bake", 0, 3, 100), "bake   0 %  0 texels/s  --:-- left");
}

TEST(ProgressLine, AStepThatMakesNoTexelsIsNamed)
{
    EXPECT_EQ(progress_line("sort cut-outs", 0, 0, 0), "sort cut-outs ...");
}

TEST(ProgressLine, NeitherAHundredPercentNorNoTimeIsToldTooSoon)
{
    EXPECT_EQ(progress_line("bake", 0.999, 1000, 1000000), "bake  99 %  999 texels/s  00:02 left");
}

TEST(ProgressLine, RatesHaveThreeDigitsAndAPrefix)
{
    const auto rate = [](int64_t texels) {
        const std::string line = progress_line("x", 1, 1, texels);
        return line.substr(9, line.find("texels") - 9);
    };
    EXPECT_EQ(rate(7), "7 ");
    EXPECT_EQ(rate(999), "999 ");
    EXPECT_EQ(rate(1000), "1.00 k ");
    EXPECT_EQ(rate(31449), "31.4 k ");
    EXPECT_EQ(rate(999400), "999 k ");
    EXPECT_EQ(rate(999600), "1.00 M ");
    EXPECT_EQ(rate(2500000000), "2.50 G ");
}

TEST(ProgressLine, TimesBeyondAnHourHaveHours)
{
    EXPECT_EQ(progress_line("bake", 0.5, 3599, 0), "bake  50 %  59:59 left");
    EXPECT_EQ(progress_line("bake", 0.5, 7322, 0), "bake  50 %  2:02:02 left");
}
