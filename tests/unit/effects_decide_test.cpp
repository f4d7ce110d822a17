// SPDX-License-Identifier: Apache-2.0
// Decisions on effects: a scene that calls for each and one that does not; the effects of a bake, and their shares of
// the work.
#include "effect_facts.h"

#include <algorithm>
#include <string>
#include <vector>

using namespace vmlight;
using namespace vmlight::effect_facts;

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
              "12 triangles: 0 opaque, 0 transparent, 12 in part, where 10 % of the cells need the texture");
    EXPECT_EQ(find(on, "max-distance"), "rays end after 3, and the scene is 10 across");
    EXPECT_EQ(find(on, "poses"), "24 poses; texels are traced again where V may change by more than 0.01");
    const auto off = decided("vismap", nothing());
    EXPECT_EQ(find(off, "poses"), "one pose is given");
    EXPECT_EQ(find(off, "self-occlusion"), "nothing rises above the tangent plane of any of 1000 triangles");
    EXPECT_EQ(find(off, "normal-map"), "it is flat: every normal stays as it is");
    EXPECT_EQ(find(off, "occluders"), "500 triangles, all below the tangent plane of each of 1000 triangles");
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
