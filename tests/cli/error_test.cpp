// SPDX-License-Identifier: Apache-2.0
// A bake for an error, or for a time, on the command line.
#include "command_test.h"

#include <algorithm>
#include <cstdio>

using namespace vmlight;
using testing::ContainsRegex;
using testing::HasSubstr;
using testing::Not;

namespace {

class Errors : public CommandTest
{
protected:
    const std::string bake = "makevismap {spot} --resolution 64 --reconstruct off ";

    struct Printed
    {
        double error = -1;
        int texels = 0, rays = 0;
    };
    /// What the line says that a bake prints about its error.
    static Printed error_line(const std::string& text)
    {
        Printed printed;
        int end = 0;
        const size_t at = std::min(text.find("error: "), text.size());
        std::sscanf(text.c_str() + at, "error: %lf (RMS of V, from %d texels baked twice) at %d rays per texel; %n",
                    &printed.error, &printed.texels, &printed.rays, &end);
        EXPECT_GT(end, 0) << text;
        return printed;
    }
    std::string samples(const std::string& image) const { return attribute(image, "vmlight:samples"); }
};

} // namespace

TEST_F(Errors, ATargetErrorIsMetPrintedAndStored)
{
    const Printed printed = error_line(done(bake + "--target-error 0.02 -o a.exr"));
    EXPECT_LE(printed.error, 0.02);
    EXPECT_GT(printed.texels, 1000);
    const std::string rays = std::to_string(printed.rays);
    EXPECT_EQ(samples("a.exr"), rays);
    EXPECT_EQ(attribute("a.exr", "vmlight:target_error"), "0.02");
    EXPECT_NEAR(std::stod(attribute("a.exr", "vmlight:error")), printed.error, 0.001);
    done(bake + "--target-error 0.02 -o b.exr --threads 1");
    EXPECT_TRUE(read("a.exr") == read("b.exr"));
    EXPECT_THAT(done(bake + "--samples " + rays + " -o c.exr"), Not(HasSubstr("error:")));
    EXPECT_EQ(attribute("c.exr", "vmlight:error"), "");
    expect_same_pixels("a.exr", "c.exr", 0);
}

TEST_F(Errors, ATargetOfAReconstructedMapTakesFewerRays)
{
    const std::string reconstructed = "makevismap {spot} --resolution 64 ";
    const int rays = error_line(done(bake + "--target-error 0.02 -o a.exr")).rays;
    EXPECT_THAT(done(reconstructed + "--target-error 0.02 -o b.exr"),
                ContainsRegex("error: 0.0[12][0-9]* \\(RMS of V, from texels that were traced with more rays\\) at "));
    EXPECT_LT(std::stoi(samples("b.exr")), rays);
    EXPECT_LE(std::stod(attribute("b.exr", "vmlight:error")), 0.02);
    // Measuring the error changes no pixel.
    done(reconstructed + "--samples " + samples("b.exr") + " -o c.exr");
    expect_same_pixels("b.exr", "c.exr", 0);
}

TEST_F(Errors, TheChannelHoldsAnEstimate)
{
    EXPECT_EQ(error_line(done(bake + "--channels error --samples 32 -o a.exr")).rays, 32);
    EXPECT_THAT(channel_names("a.exr"), testing::Contains("error"));
    EXPECT_NE(attribute("a.exr", "vmlight:error"), "");
    refused(1, "samples: 1 is too few for the channel error, which needs 2",
            bake + "-o x.exr --channels error --samples 1");
}

TEST_F(Errors, WhereNothingIsOccludedOneRayIsEnough)
{
    make_vismap();
    EXPECT_THAT(done("makevismap quad.obj -o a.exr --resolution 32 --reconstruct off --target-error 1e-3"),
                HasSubstr("error: 0 (1024 texels baked twice are identical) at 1 ray per texel"));
    EXPECT_EQ(attribute("a.exr", "vmlight:error"), "0");
}

TEST_F(Errors, OneTexelThatAgreesWithItselfTakes64Rays)
{
    write("quad.obj", kQuad);
    EXPECT_THAT(done("makevismap quad.obj -o a.exr --resolution 1 --reconstruct off --target-error 1e-3"),
                HasSubstr("error: 0 (1 texel baked twice is identical) at 64 rays per texel; "));
    EXPECT_EQ(samples("a.exr"), "64");
}

TEST_F(Errors, AnErrorOutOfReachIsRefused)
{
    refused(1, "--target-error: 1e-09 is out of reach: 1048576 rays per texel give ",
            "makevismap {spot} --resolution 16 -o x.exr --target-error 1e-9");
}

TEST_F(Errors, ATimeGivesTheRaysAndTheFileStoresThem)
{
    const std::string rays = std::to_string(error_line(done(bake + "--time-budget 0.05 -o a.exr")).rays);
    EXPECT_EQ(samples("a.exr"), rays);
    EXPECT_EQ(attribute("a.exr", "vmlight:target_error"), "none");
    EXPECT_NE(attribute("a.exr", "vmlight:error"), "");
    EXPECT_EQ(attribute("a.exr", "vmlight:time_budget"), "");
    done(bake + "--samples " + rays + " -o b.exr");
    expect_same_pixels("a.exr", "b.exr", 0);
}

TEST_F(Errors, ATimeTooShortForOneRayTakesOneWithAWarning)
{
    EXPECT_THAT(done("makevismap {spot} --resolution 2048 --margin 0 --reconstruct off --time-budget 0.001 -o a.exr"),
                ContainsRegex(
                    "WARNING: --time-budget: even 1 ray per texel, the minimum, takes about .* s, more than 0.001\n"));
    EXPECT_EQ(samples("a.exr"), "1");
}

TEST_F(Errors, ATimeIsNoPartOfARecipe)
{
    refused(2, "--time-budget cannot be saved in a recipe", bake + "--time-budget 1 --print-recipe");
    refused(2, "--time-budget: 0 is not in [0.001, 1e+06]", bake + "--time-budget 0 -o x.exr");
    const std::string recipe = run(bake + "--target-error 0.05 --channels error,normal --print-recipe").out;
    EXPECT_THAT(recipe, HasSubstr("target_error = 0.05\nreconstruct = \"off\"\nchannels = [\"normal\", \"error\"]\n"));
    write("hero.vismap", recipe);
    error_line(done("makevismap hero.vismap -o a.exr"));
    refused(2, "--time-budget 1: target_error sets", "makevismap hero.vismap -o x.exr --time-budget 1");
    done("makevismap hero.vismap -o a.exr --target-error none --samples 4");
    EXPECT_EQ(samples("a.exr"), "4");
    write("time.vismap", "time_budget = 1\n");
    refused(1, "unknown parameter \"time_budget\"", "makevismap time.vismap -o x.exr");
}
