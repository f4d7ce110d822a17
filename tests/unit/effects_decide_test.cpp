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
    bake.reach = bake.given_reach = 3;
    bake.margin = 16;
    bake.udim = 1002;
    bake.udim_given = bake.half = true;
    bake.poses = 24;
    bake.pose_error = 0.01;
    LightFacts& light = facts.light;
    light.converts_color = true;
    light.color_note = "sRGB to ACEScg";
    light.rotation_degrees = 90;
    light.has_albedo = light.has_environment = light.wants_bounce = light.wants_suns = true;
    light.albedo_low = 0.1;
    light.albedo_high = 0.9;
    light.levels = 16;
    light.model = "lobe";
    light.lit = 100;
    light.shadowed = 60;
    light.bounce_rays = 64;
    light.suns = 2;
    light.sun_share = 0.5;
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
    facts.light.lit = 100;
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

EffectDecision named(const char* name, const EffectFacts& facts, const char* text = "auto")
{
    for (const char* stage : { "vismap", "lightmap" })
        for (const Effect& effect : all_effects())
            if (effect.name == std::string(name) && effect.stage == std::string(stage))
                for (const EffectDecision& decision : decided(stage, facts, text))
                    if (decision.name == name)
                        return decision;
    ADD_FAILURE() << name;
    return {};
}

std::string switch_refusal(const EffectFacts& facts, const char* text, const char* stage = "vismap")
{
    std::string error;
    decide(stage, facts, text, error);
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

// Where most of the bake is tracing, and a look at a texture at many hits.
TEST(EffectsDecide, SharesAddUpToLessThanOne)
{
    for (const double open : { 0.0, 0.5, 1.0 })
        for (const int64_t unknown : { 0, 300 })
            for (const char* stage : { "vismap", "lightmap" })
                for (const char* switches : { "auto", "all" }) {
                    EffectFacts facts = everything();
                    facts.bake.open_share = open;
                    facts.bake.cutouts.unknown = unknown;
                    double share = 0;
                    for (const EffectDecision& decision : decided(stage, facts, switches))
                        share += decision.share;
                    EXPECT_LT(share, 1) << stage << " " << open;
                    EXPECT_GT(share, 0) << stage << " " << open;
                }
    EffectFacts few = everything(), many = everything();
    few.bake.cutouts.unknown = 3;
    many.bake.cutouts.unknown = 290;
    EXPECT_LT(named("cut-outs", few).share, named("cut-outs", many).share);
    // What is switched off takes nothing, and the others all of the work.
    EXPECT_EQ(named("self-occlusion", few, "-self-occlusion").share, 0);
    EXPECT_GT(named("occluders", few, "-self-occlusion").share, named("occluders", few).share);
}

TEST(EffectsDecide, TheGroundIsWhereItIs)
{
    EffectFacts facts = everything();
    facts.bake.lowest = 1;
    const auto reason = [&](double height) {
        facts.bake.ground_height = height;
        return named("ground", facts).reason;
    };
    EXPECT_EQ(reason(1), "the plane y = 1 touches the mesh; no ray is traced for it");
    EXPECT_EQ(reason(0.5), "the plane y = 0.5 is 0.5 below the mesh; no ray is traced for it");
    EXPECT_EQ(reason(1.5), "the plane y = 1.5 is 0.5 above the lowest point of the mesh; no ray is traced for it");
    EXPECT_EQ(reason(-3), "the plane y = -3 is 4 below the mesh, and rays reach 3");
    EXPECT_FALSE(named("ground", facts).on);
    facts.bake.reach = 9; // as if --max-distance 3 were switched off
    EXPECT_TRUE(named("ground", facts).on);
    EXPECT_EQ(named("max-distance", facts).reason, "rays end after 3, and the scene is 10 across");
    facts.bake.faces_up = true;
    EXPECT_EQ(reason(0.5), "the plane y = 0.5 is 0.5 below the mesh, and every texel faces straight up");
    EXPECT_FALSE(named("ground", facts).called_for);
    reason(1.5);
    EXPECT_TRUE(named("ground", facts).called_for) << "a texel under the ground sees nothing";
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
