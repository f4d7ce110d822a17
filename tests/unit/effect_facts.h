// SPDX-License-Identifier: Apache-2.0
/// Facts of a scene that calls for every effect and of one that calls for none, and what is decided on them.
#pragma once

#include <vmlight/effects/effect.h>

#include <gtest/gtest.h>

#include <string>
#include <vector>

namespace vmlight::effect_facts {

/// Facts of a scene that calls for every effect.
inline EffectFacts everything()
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

/// Facts of a scene that calls for none.
inline EffectFacts nothing()
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

/// With switches as a text has them.
inline std::vector<EffectDecision> decide(const char* stage, const EffectFacts& facts, const char* text,
                                          std::string& error)
{
    EffectSwitches switches;
    std::vector<EffectDecision> decisions;
    if (EffectSwitches::parse(switches, text, stage, error))
        decide_effects(decisions, stage, facts, switches, error);
    return decisions;
}

/// The same of switches that must be right.
inline std::vector<EffectDecision> decided(const char* stage, const EffectFacts& facts, const char* text = "auto")
{
    std::string error;
    const auto decisions = decide(stage, facts, text, error);
    EXPECT_EQ(error, "");
    return decisions;
}

/// Of the effect of that name.
inline EffectDecision named(const char* name, const EffectFacts& facts, const char* text = "auto")
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

} // namespace vmlight::effect_facts
