// SPDX-License-Identifier: Apache-2.0
// vmcost's table of effects: what a scene calls for, and what leaving it out costs.
#include "cost_run.h"

#include <cmath>

using namespace vmlight;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::Not;

namespace {

class CostEffects : public CostTest
{
protected:
    nlohmann::json effects() const { return nlohmann::json::parse(read("report/costs.json"))["effects"]; }
    std::vector<std::string> measured_effects(const std::string& words)
    {
        cost(words + small);
        std::vector<std::string> names;
        for (const auto& effect : effects())
            names.push_back(effect["effect"]);
        return names;
    }
    nlohmann::json effect(const std::string& name) const
    {
        for (const auto& one : effects())
            if (one["effect"] == name)
                return one;
        ADD_FAILURE() << "no " << name;
        return {};
    }
    void make_normal_map(const std::string& name, float lean) const
    {
        OIIO::ImageBuf image(OIIO::ImageSpec(4, 4, 3, OIIO::TypeFloat));
        OIIO::ImageBufAlgo::fill(image, { 0.5f + 0.5f * std::sin(lean), 0.5f, 0.5f + 0.5f * std::cos(lean) });
        ASSERT_TRUE(image.write(path(name))) << image.geterror();
    }
};

} // namespace

TEST_F(CostEffects, OnlyWhatTheSceneCallsForIsMeasured)
{
    write("step.obj", kQuad); // alone, nothing is in its way
    EXPECT_THAT(measured_effects("sky.exr"), IsEmpty());
    EXPECT_THAT(read("report/report.html"), HasSubstr("This scene calls for none"));
    make_normal_map("flat.exr", 0);
    EXPECT_THAT(measured_effects("sky.exr --normal-map flat.exr"), IsEmpty());
    make_normal_map("lean.exr", 0.5f);
    write("under.obj", "v -1 -1 -1\nv 0 -1 -1\nv 0 1 -1\nf 1 2 3\n");
    EXPECT_THAT(measured_effects("sky.exr --normal-map lean.exr --occluder under.obj"), ElementsAre("normal-map"));
    EXPECT_GT(double(effect("normal-map")["light_error_without"]), 0.01);
}

TEST_F(CostEffects, WhatIsLeftOutIsOffByAsMuchAsItIsSeen)
{
    // A wall on the ground sees half of the sky: without the ground, light of 1, 2, 3 is off by half of that.
    write("step.obj", kQuad);
    EXPECT_THAT(measured_effects("sky.exr --ground"), ElementsAre("ground", "reconstruction"));
    EXPECT_EQ(double(effect("reconstruction")["light_error_without"]), 0) << "the ground's share is exact";
    EXPECT_NEAR(double(effect("ground")["visibility_error_without"]), 0.5, 1e-6);
    EXPECT_NEAR(double(effect("ground")["light_error_without"]), std::sqrt((0.25 + 1 + 2.25) / 3), 1e-5);
    EXPECT_GT(double(effect("ground")["seconds"]), 0);
    const std::string page = read("report/report.html");
    EXPECT_THAT(page, HasSubstr("<td>ground</td>"));
    EXPECT_THAT(page, HasSubstr("<td>0.500</td><td>108 %</td>"));
    EXPECT_THAT(page, testing::ContainsRegex("makevismap step.obj [-a-z0-9 ]*--ground "));
}

TEST_F(CostEffects, SunsAndWhatIsInTheirWay)
{
    OIIO::ImageBuf sunny(OIIO::ImageSpec(128, 64, 3, OIIO::TypeFloat));
    OIIO::ImageBufAlgo::fill(sunny, { 1.0f, 1.0f, 1.0f });
    const float sun[] { 3000, 3000, 3000 };
    sunny.setpixel(70, 20, sun);
    ASSERT_TRUE(sunny.write(path("sunny.exr"))) << sunny.geterror();
    write("roof.obj", "v -1 -1 1.5\nv 0 -1 1.5\nv 0 1 1.5\nf 1 2 3\n");
    EXPECT_THAT(measured_effects("sunny.exr --occluder roof.obj --max-distance 3"),
                ElementsAre("self-occlusion", "occluders", "max-distance", "reconstruction", "suns", "bounce"));
    for (const char* name : { "self-occlusion", "occluders" })
        EXPECT_GT(double(effect(name)["visibility_error_without"]), 0.01) << name;
    EXPECT_EQ(double(effect("suns")["visibility_error_without"]), 0);
    EXPECT_GT(double(effect("suns")["light_error_without"]), 0.01);
    EXPECT_THAT(std::string(effect("suns")["reason"]), HasSubstr("1 sun in 1 of 1 environment"));
}

// Two squares at a right angle, of which each sees .20004 of the other (a textbook form factor): the sky lights the
// quad by .8, the wall adds .06 to .1 to that, mostly near the edge. RMS is at least the mean.
TEST_F(CostEffects, ABounceBetweenSurfaces)
{
    write("wall.obj", "v -1 -1 0\nv -1 1 0\nv -1 1 2\nv -1 -1 2\nf 1 2 3 4\n");
    EXPECT_THAT(measured_effects("sky.exr --occluder wall.obj"),
                ElementsAre("self-occlusion", "occluders", "reconstruction", "bounce"));
    const nlohmann::json bounce = effect("bounce");
    EXPECT_EQ(double(bounce["visibility_error_without"]), 0);
    EXPECT_GT(double(bounce["light_error_without"]), 0.06 / 0.9);
    EXPECT_LT(double(bounce["light_error_without"]), 0.25);
    EXPECT_THAT(std::string(bounce["reason"]), HasSubstr("send back 0.5 of their light"));
    EXPECT_GT(double(bounce["seconds"]), 0);
}

TEST_F(CostEffects, AGroundIsAnotherScene)
{
    cost("sky.exr" + small);
    const int count = measured;
    cost("sky.exr --ground" + small);
    expect_counts(count, 0, "another reference and other maps");
    refused(2, "--ground-height 1: no ground is given", "vmcost step.obj sky.exr -o report --ground-height 1");
    refused(2, "no normal map is given", "vmcost step.obj sky.exr -o report --normal-map-green down");
}
