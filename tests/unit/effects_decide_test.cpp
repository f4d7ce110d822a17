// SPDX-License-Identifier: Apache-2.0
// Decisions on effects: a scene that calls for each and one that does not, switches, and what they refuse.
#include <vmlight/effects/effect.h>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

using namespace vmlight;

namespace {

// Facts of a scene that calls for every effect.
EffectFacts everything()
{
    EffectFacts facts;
    BakeFacts& bake = facts.bake;
    bake.triangles = 1000;
    bake.open_triangles = 250;
    bake.open_share = 0.25;
    bake.proven = true;
    bake.covered = 5000;
    bake.texels = 10000;
    bake.occluders = { { "tree", 500, CasterReach::reaches, 2 } };
    bake.has_ground = true;
    bake.cutouts.triangles = bake.cutouts.mixed = 12;
    bake.cutouts.cells = 300;
    bake.cutouts.unknown = 30;
    bake.has_normal_map = true;
    bake.diagonal = 10;
    bake.reach = 3;
    bake.margin = 16;
    bake.udim = 1002;
    bake.udim_given = bake.half = true;
    bake.poses = 24;
    bake.pose_error = 0.01;
    facts.light = {
        true, "sRGB to ACEScg", 90, true, 0.1, 0.9, 16, "lobe", true, false, 100, 60, 0, true, 64, true, "", 2, 0.5
    };
    return facts;
}

// Facts of a scene that calls for none.
EffectFacts nothing()
{
    EffectFacts facts;
    BakeFacts& bake = facts.bake;
    bake.triangles = bake.open_triangles = 1000;
    bake.open_share = 1;
    bake.proven = true;
    bake.covered = bake.texels = 10000;
    bake.diagonal = 10;
    bake.occluders = { { "tree", 500, CasterReach::below_horizon, 2 } };
    bake.has_normal_map = bake.has_flat_normal_map = true;
    facts.light.levels = 1;
    facts.light.model = "paper";
    facts.light.has_albedo = true;
    facts.light.albedo_low = facts.light.albedo_high = 1;
    return facts;
}

std::vector<EffectDecision> decide(const char* stage, const EffectFacts& facts, const char* text, std::string& error)
{
    EffectSwitches switches;
    std::vector<EffectDecision> decisions;
    if (EffectSwitches::parse(switches, text, stage, error))
        decide_effects(decisions, stage, facts, switches, error);
    return decisions;
}

std::vector<EffectDecision> decided(const char* stage, const EffectFacts& facts, const char* text = "auto")
{
    std::string error;
    const auto decisions = decide(stage, facts, text, error);
    EXPECT_EQ(error, "");
    return decisions;
}

std::string refusal(const EffectFacts& facts, const char* text)
{
    std::string error;
    decide("vismap", facts, text, error);
    return error;
}

} // namespace

TEST(EffectsDecide, EachIsOnWhereTheSceneCallsForItAndOffWhereNot)
{
    size_t rows = 0;
    for (const char* stage : { "vismap", "lightmap" }) {
        const auto on = decided(stage, everything()), off = decided(stage, nothing());
        ASSERT_EQ(on.size(), off.size());
        rows += on.size();
        double share = 0;
        for (size_t i = 0; i < on.size(); ++i) {
            EXPECT_TRUE(on[i].on && on[i].called_for) << on[i].name;
            EXPECT_FALSE(off[i].on || off[i].called_for) << off[i].name;
            EXPECT_NE(on[i].reason, off[i].reason) << on[i].name;
            EXPECT_EQ(off[i].share, 0) << off[i].name;
            share += on[i].share;
            for (const EffectDecision& decision : { on[i], off[i] })
                EXPECT_FALSE(decision.reason.empty() || decision.reason.back() == '.') << decision.name;
        }
        EXPECT_LE(share, 1);
        EXPECT_GT(share, 0.1);
    }
    EXPECT_EQ(rows, size_t(all_effects().size()));
}

TEST(EffectsDecide, ABounceNeedsAllThatItIsMadeOf)
{
    const auto bounce = [](const EffectFacts& facts) {
        const auto decisions = decided("lightmap", facts);
        return *std::find_if(decisions.begin(), decisions.end(),
                             [](const EffectDecision& decision) { return decision.name == "bounce"; });
    };
    EXPECT_THAT(bounce(everything()).reason, testing::HasSubstr("send back up to 0.9 of their light; 64 rays a texel"));
    EffectFacts facts = everything();
    facts.light.wants_bounce = false;
    EXPECT_EQ(bounce(facts).reason, "not asked for: --bounce auto adds it");
    EXPECT_NE(bounce(facts).impossible, "");
    facts = everything();
    facts.light.has_albedo = false;
    EXPECT_EQ(bounce(facts).reason, "no albedo is given, so that nothing is sent back");
    facts = everything();
    facts.light.albedo_low = facts.light.albedo_high = 0;
    EXPECT_EQ(bounce(facts).reason, "the albedo is 0 everywhere");
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

TEST(EffectsDecide, ReasonsHaveTheNumbers)
{
    const auto find = [](const std::vector<EffectDecision>& decisions, const char* name) {
        const auto found = std::find_if(decisions.begin(), decisions.end(),
                                        [&](const EffectDecision& decision) { return decision.name == name; });
        return found == decisions.end() ? std::string() : found->reason;
    };
    const auto on = decided("vismap", everything());
    EXPECT_EQ(find(on, "self-occlusion"),
              "something rises above 750 of 1000 triangles; the rest, 25 % of the UV area, trace no ray");
    EXPECT_EQ(find(on, "occluders"), "500 triangles, 2 away, may rise above the horizon of a texel");
    EXPECT_EQ(find(on, "cut-outs"),
              "12 triangles: 0 opaque, 0 transparent, 12 in part, where 10 % of the cells ask the texture");
    EXPECT_EQ(find(on, "max-distance"), "rays end after 3, and the scene is 10 across");
    EXPECT_EQ(find(on, "poses"), "24 poses; texels are traced again where V may change by more than 0.01");
    const auto off = decided("vismap", nothing());
    EXPECT_EQ(find(off, "poses"), "one pose is given");
    EXPECT_EQ(find(off, "self-occlusion"), "nothing rises above the tangent plane of any of 1000 triangles");
    EXPECT_EQ(find(off, "normal-map"), "it is flat: every normal stays as it is");
    EXPECT_EQ(find(off, "occluders"), "500 triangles, all below the tangent plane of each of 1000 triangles");
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
    facts.light.is_one_color = true;
    facts.light.shadowed = 0;
    EXPECT_EQ(state("lightmap", facts, "filter"), "off: the environment is of one colour, which no filter changes");
    EXPECT_EQ(state("lightmap", facts, "stack-levels"),
              "off: the light is of one colour: V times it, wherever texels look");
    EXPECT_EQ(state("lightmap", facts, "visibility"), "off: V is 1 in all of 100 texels: the light of the open sky");
    facts.bake.cutouts.mixed = 0;
    facts.bake.cutouts.opaque = facts.bake.cutouts.triangles;
    EXPECT_EQ(state("vismap", facts, "cut-outs"), "off: 12 triangles, opaque wherever a texture covers them");
    facts.bake.cutouts.opaque = 0;
    facts.bake.cutouts.transparent = facts.bake.cutouts.triangles;
    EXPECT_EQ(state("vismap", facts, "cut-outs").substr(0, 3), "on:");
}

TEST(EffectsDecide, SwitchesOverrideOneByOne)
{
    const auto state = [](const char* text) {
        std::string states;
        for (const EffectDecision& decision : decided("vismap", nothing(), text))
            states += decision.on ? '1' : '0';
        return states;
    };
    // self-occlusion, occluders, ground, cut-outs, normal-map, max-distance, poses, udim, margin, half
    EXPECT_EQ(state("auto"), "0000000000");
    EXPECT_EQ(state("all"), "1100100000") << "what is not given cannot be forced";
    EXPECT_EQ(state("+occluders"), "0100000000");
    EXPECT_EQ(state("all,-occluders"), "1000100000");
    EXPECT_EQ(state(" auto , +self-occlusion "), "1000000000");
}

TEST(EffectsDecide, WhatIsLeftOutThoughCalledForIsNamed)
{
    EXPECT_EQ(left_out(decided("vismap", everything(), "-ground,-occluders")), "occluders \"tree\", ground");
    EXPECT_EQ(left_out(decided("vismap", nothing(), "-ground,-occluders")), "");
}

TEST(EffectsDecide, TheImpossibleIsRefused)
{
    EXPECT_EQ(refusal(nothing(), "+ground"), "effects: +ground is impossible: no --ground is given");
    EXPECT_EQ(refusal(nothing(), "+poses"),
              "effects: +poses is impossible: one pose is given: give --frames or --pose");
    EXPECT_EQ(refusal(everything(), "-udim"), "effects: -udim: cannot be left out: tile 1002 of UV space");
    EXPECT_EQ(refusal(everything(), "+gruond"),
              "\"gruond\" is not an effect: did you mean \"ground\"?; there are self-occlusion, occluders, ground, "
              "cut-outs, normal-map, max-distance, poses, udim, margin, half");
    EXPECT_EQ(refusal(everything(), "ground"),
              "\"ground\" is not a switch: auto, all, or + or - before the name of an effect: self-occlusion, "
              "occluders, ground, cut-outs, normal-map, max-distance, poses, udim, margin, half");
    EXPECT_EQ(refusal(everything(), "+ground,-ground"), "\"ground\" is named twice");
    EXPECT_EQ(refusal(everything(), "+ground,all"), "\"all\" must be the first word");
}

TEST(EffectsDecide, ATableHasALineForEach)
{
    const auto decisions = decided("vismap", everything(), "-ground");
    const std::vector<std::string> lines = decision_lines(decisions);
    ASSERT_EQ(lines.size(), decisions.size());
    EXPECT_NE(lines[2].find("switched off"), std::string::npos) << lines[2];
    EXPECT_NE(lines[1].find("occluders \"tree\"  on"), std::string::npos) << lines[1];
}
