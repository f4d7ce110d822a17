// SPDX-License-Identifier: Apache-2.0
// Switches of effects: what they force and leave out, and what they cannot, with the reason.
#include "effect_facts.h"

#include <gmock/gmock.h>

#include <string>
#include <vector>

using namespace vmlight;
using namespace vmlight::effect_facts;

namespace {

std::string switch_refusal(const EffectFacts& facts, const char* text, const char* stage = "vismap")
{
    std::string error;
    decide(stage, facts, text, error);
    return error;
}

} // namespace

TEST(EffectsDecide, SwitchesOverrideOneByOne)
{
    const auto state = [](const char* text) {
        std::string states;
        for (const EffectDecision& decision : decided("vismap", nothing(), text))
            states += decision.on ? '1' : '0';
        return states;
    };
    // self-occlusion, occluders, ground, cut-outs, normal-map, max-distance, poses, udim, reconstruction, margin, half
    EXPECT_EQ(state("auto"), "00000000000");
    EXPECT_EQ(state("all"), "11000000000") << "what is not given cannot be forced";
    EXPECT_EQ(state("+normal-map,+reconstruction"), "00000000000") << "nor is what has nothing to do";
    EXPECT_EQ(state("+occluders"), "01000000000");
    EXPECT_EQ(state("all,-occluders"), "10000000000");
    EXPECT_EQ(state(" auto , +self-occlusion "), "10000000000");
}

// Only where there is work to force: a flat normal map has none, whatever the switch.
TEST(EffectsDecide, NothingIsSaidToBeForcedThatIsNot)
{
    EffectFacts facts = nothing();
    facts.bake.cutouts.triangles = facts.bake.cutouts.opaque = 12;
    facts.bake.has_ground = true;
    facts.bake.ground_height = -5;
    facts.bake.reach = facts.bake.given_reach = 2;
    facts.light.wants_suns = facts.light.wants_bounce = facts.light.has_environment = facts.light.is_one_color = true;
    size_t forced = 0;
    for (const Effect& effect : all_effects())
        for (const EffectDecision& decision : decided(effect.stage, facts, "all"))
            if (decision.name == effect.name) {
                EXPECT_EQ(decision.on, decision.called_for || (effect.can_be_forced && decision.impossible.empty()))
                    << effect.name;
                forced += decision.on && !decision.called_for;
            }
    EXPECT_EQ(forced, 6u);
    for (const char* name : { "ground", "normal-map" })
        EXPECT_THAT(testing::PrintToString(decision_lines(decided("vismap", facts, "all"))),
                    testing::ContainsRegex(std::string(name) + " +off "));
}

TEST(EffectsDecide, CutOutsThatAreNotAskedForAreNotSaidToBeMissing)
{
    EffectFacts facts = nothing();
    facts.bake.no_cutouts = true;
    EXPECT_EQ(named("cut-outs", facts).reason, "cutouts is off: every material is opaque");
    EXPECT_EQ(switch_refusal(facts, "+cut-outs"),
              "effects: +cut-outs is impossible: cutouts is off: every material is opaque");
}

TEST(EffectsDecide, TexelsAreAveragedUnlessThatIsUnsoundOrNothingBlocksThem)
{
    EffectFacts facts = everything();
    EXPECT_EQ(named("reconstruction", facts).reason,
              "each of 5000 texels is averaged with those of the 48 around it that see the same");
    facts.bake.no_reconstruct = "reconstruct is off";
    EXPECT_EQ(named("reconstruction", facts).reason,
              "reconstruct is off: each of 5000 texels has what its own rays see");
    EXPECT_FALSE(named("reconstruction", facts).called_for);
    EXPECT_EQ(switch_refusal(facts, "+reconstruction"), "effects: +reconstruction is impossible: reconstruct is off");
    facts = nothing();
    EXPECT_EQ(named("reconstruction", facts).reason, "nothing blocks a ray of any of 10000 texels");
    facts.bake.has_ground = true; // which, near enough, is sampled
    EXPECT_TRUE(named("reconstruction", facts).on);
}

TEST(EffectsDecide, WhatIsLeftOutThoughCalledForIsNamed)
{
    EXPECT_EQ(left_out(decided("vismap", everything(), "-margin,-reconstruction")), "")
        << "no texel of the mesh sees something else";
    EXPECT_EQ(left_out(decided("vismap", everything(), "-ground,-occluders")), "occluders \"tree\", ground");
    EXPECT_EQ(left_out(decided("vismap", nothing(), "-ground,-occluders")), "");
}

TEST(EffectsDecide, TheImpossibleIsRefused)
{
    EXPECT_EQ(switch_refusal(nothing(), "+ground"), "effects: +ground is impossible: no --ground is given");
    EXPECT_EQ(switch_refusal(nothing(), "+poses"),
              "effects: +poses is impossible: one pose is given: give --frames or --pose");
    EXPECT_EQ(switch_refusal(everything(), "-udim"), "effects: -udim: cannot be left out: tile 1002 of UV space");
    EXPECT_EQ(switch_refusal(everything(), "-filter", "lightmap"),
              "effects: -filter: cannot be left out: an environment is given");
    for (const Effect& effect : all_effects())
        EXPECT_EQ(switch_refusal(nothing(), (std::string("-") + effect.name).c_str(), effect.stage), "") << effect.name;
    EXPECT_EQ(
        switch_refusal(everything(), "+gruond"),
        "\"gruond\" is not an effect: did you mean \"ground\"? The effects are self-occlusion, occluders, ground, "
        "cut-outs, normal-map, max-distance, poses, udim, reconstruction, margin, half");
    EXPECT_EQ(switch_refusal(everything(), "ground"),
              "\"ground\" is not a switch: auto, all, or + or - before the name of an effect: self-occlusion, "
              "occluders, ground, cut-outs, normal-map, max-distance, poses, udim, reconstruction, margin, half");
    EXPECT_EQ(switch_refusal(everything(), "+ground,-ground"), "\"ground\" is named twice");
    EXPECT_EQ(switch_refusal(everything(), "+ground,all"), "\"all\" must be the first word");
}

TEST(EffectsDecide, ATableHasALineForEach)
{
    const auto decisions = decided("vismap", everything(), "-ground");
    const std::vector<std::string> lines = decision_lines(decisions);
    ASSERT_EQ(lines.size(), decisions.size());
    EXPECT_NE(lines[2].find("switched off"), std::string::npos) << lines[2];
    EXPECT_NE(lines[1].find("occluders \"tree\"  on"), std::string::npos) << lines[1];
}
