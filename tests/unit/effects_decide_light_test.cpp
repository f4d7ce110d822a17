// SPDX-License-Identifier: Apache-2.0
// Decisions on the effects of light: bounces, suns, filters, and what cannot change the picture.
#include "effect_facts.h"

#include <gmock/gmock.h>

#include <algorithm>
#include <string>

using namespace vmlight;
using namespace vmlight::effect_facts;

TEST(EffectsDecide, ABounceNeedsAllThatItIsMadeOf)
{
    const auto bounce = [](const EffectFacts& facts) {
        const auto decisions = decided("lightmap", facts);
        return *std::find_if(decisions.begin(), decisions.end(),
                             [](const EffectDecision& decision) { return decision.name == "bounce"; });
    };
    EXPECT_THAT(bounce(everything()).reason, testing::HasSubstr("send back up to 0.9 of their light; 64 rays a texel"));
    EffectFacts facts = everything();
    facts.light.is_black = true;
    EXPECT_EQ(bounce(facts).reason, "the light is black");
    EXPECT_FALSE(bounce(facts).on);
    facts = everything();
    facts.light.wants_bounce = false;
    EXPECT_EQ(bounce(facts).reason, "not asked for: --bounce auto adds it");
    EXPECT_NE(bounce(facts).impossible, "");
    facts = everything();
    facts.light.has_albedo = false;
    EXPECT_EQ(bounce(facts).reason, "no albedo is given: surfaces send nothing back");
    facts = everything();
    facts.light.albedo_low = facts.light.albedo_high = 0;
    EXPECT_EQ(bounce(facts).reason, "the albedo is 0 everywhere");
    facts = everything();
    facts.light.albedo_low = 1;
    facts.light.albedo_high = 0; // not read
    EXPECT_EQ(bounce(facts).reason, "the albedo is switched off: surfaces send nothing back");
    EXPECT_FALSE(bounce(facts).called_for);
    facts = everything();
    facts.light.no_bounce = "\"vm.exr\" is only a part of a map";
    EXPECT_EQ(bounce(facts).reason, "\"vm.exr\" is only a part of a map");
    EXPECT_FALSE(bounce(facts).called_for);
    EXPECT_NE(bounce(facts).impossible, "");
    facts = everything();
    facts.light.shadowed = 0;
    facts.light.hidden = 1; // what it sees may be lit from elsewhere
    EXPECT_TRUE(bounce(facts).on);
    facts.light.hidden = 0;
    EXPECT_EQ(bounce(facts).reason, "no texel sees a surface");
    EXPECT_FALSE(bounce(facts).on);
    EXPECT_EQ(bounce(facts).impossible, "");
}

// The points off the map that a bounce lights trace far more rays than the texels.
TEST(EffectsDecide, ABouncesShareIsThatOfItsRays)
{
    const auto bounce = [](double rays, double points) {
        EffectFacts facts = everything();
        facts.light.traced_rays = rays;
        facts.light.traced_points = points;
        return decided("lightmap", facts).back();
    };
    ASSERT_EQ(bounce(1e6, 0).name, "bounce");
    EXPECT_GT(bounce(2e6, 480000).share, 0.75);
    EXPECT_LT(bounce(1e5, 0).share, 0.1);
    EXPECT_GT(bounce(1e7, 1000).share, bounce(1e6, 1000).share);
    EXPECT_THAT(bounce(2e6, 480000).reason,
                testing::HasSubstr("64 rays a texel and about 480 thousand points off the map, traced once"));
    EXPECT_THAT(bounce(2e6, 0).reason, testing::Not(testing::HasSubstr("off the map")));
}

TEST(EffectsDecide, WhatCannotChangeThePictureIsOff)
{
    const auto state = [](const char* stage, const EffectFacts& facts, const char* name) {
        for (const EffectDecision& decision : decided(stage, facts))
            if (decision.name == name)
                return (decision.on ? "on: " : "off: ") + decision.reason;
        return std::string();
    };
    EffectFacts facts = everything();
    EXPECT_EQ(state("lightmap", facts, "visibility"), "on: V is below 1 in 60 of 100 texels");
    EXPECT_THAT(state("lightmap", facts, "suns"), testing::StartsWith("on: 2 suns with 50 % of the light"));
    facts.light.suns = 1;
    facts.light.wide_discs = 4;
    EXPECT_THAT(state("lightmap", facts, "suns"), testing::StartsWith("on: 1 sun and 4 wide discs with 50 % of"));
    facts.light.is_one_color = true;
    facts.light.shadowed = 0;
    EXPECT_EQ(state("lightmap", facts, "filter"), "off: the environment is of one colour, which no filter changes");
    EXPECT_EQ(state("lightmap", facts, "stack-levels"), "off: the light is of one colour in all directions");
    EXPECT_EQ(state("lightmap", facts, "visibility"), "off: V is 1 in all of 100 texels: the light of the open sky");
    facts.light.lit = 0;
    EXPECT_EQ(state("lightmap", facts, "visibility"), "off: V is 0 everywhere");
    facts.light.is_rest = true;
    EXPECT_EQ(state("lightmap", facts, "filter"),
              "off: without its suns the environment is of one colour, which no filter changes");
    facts.bake.cutouts.mixed = 0;
    facts.bake.cutouts.opaque = facts.bake.cutouts.triangles;
    EXPECT_EQ(state("vismap", facts, "cut-outs"), "off: 12 triangles, opaque wherever a texture covers them");
    facts.bake.cutouts.opaque = 0;
    facts.bake.cutouts.transparent = facts.bake.cutouts.triangles;
    EXPECT_EQ(state("vismap", facts, "cut-outs").substr(0, 3), "on:");
}
