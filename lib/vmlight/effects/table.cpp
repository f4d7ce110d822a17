// SPDX-License-Identifier: Apache-2.0
#include <vmlight/effects/effect.h>

#include <vmlight/base/format.h>
#include <vmlight/base/text_format.h>

#include <algorithm>
#include <cmath>

namespace vmlight {
namespace {

// Of the time of a texel that traces its rays, the part that tracing takes.
constexpr double kTracing = 0.85;
// What asking at triangles that are transparent in part adds (bench/cutout_bench.cpp: half as much again as tracing).
constexpr double kFiltering = 0.3;

std::string percent_text(double share)
{
    const double percent = 100 * share;
    return percent == 0 ? "0 %" : percent < 1 ? "under 1 %" : format("{:.0f} %", percent);
}

// How deep rays go into so many triangles.
double depth(int64_t triangles)
{
    return std::log2(2.0 + double(triangles));
}

// The part of tracing that a mesh has among those that are traced.
double trace_share(const BakeFacts& facts, int64_t triangles)
{
    double all = facts.self ? depth(facts.triangles) : 0;
    for (const CasterReach& caster : facts.occluders)
        if (caster.verdict == CasterReach::reaches)
            all += depth(caster.triangles);
    return all > 0 ? kTracing * (1 - facts.open_share) * depth(triangles) / all : 0;
}

EffectDecision decision(const Effect& effect, bool called_for, std::string reason, double share = 0)
{
    return { effect.name, "", called_for, called_for, std::move(reason), called_for ? share : 0, "" };
}

void decide_self_occlusion(std::vector<EffectDecision>& dst, const Effect& effect, const EffectFacts& facts)
{
    const BakeFacts& bake = facts.bake;
    const std::string triangles = count_text(bake.triangles, "triangle", "triangles");
    if (bake.open_triangles == bake.triangles && bake.triangles > 0)
        dst.push_back(decision(effect, false, format("nothing rises above the tangent plane of any of {}", triangles)));
    else if (bake.proven && bake.open_triangles > 0)
        dst.push_back(decision(effect, true,
                               format("something rises above {} of {}; the rest, {} of the UV area, trace no ray",
                                      bake.triangles - bake.open_triangles, triangles, percent_text(bake.open_share)),
                               trace_share(bake, bake.triangles)));
    else
        dst.push_back(
            decision(effect, true,
                     bake.proven ? format("something rises above each of {}", triangles)
                                 : format("{}, blocked by each other or by occluders; the few that may be free are not "
                                          "worth a search",
                                          triangles),
                     trace_share(bake, bake.triangles)));
}

void decide_occluders(std::vector<EffectDecision>& dst, const Effect& effect, const EffectFacts& facts)
{
    const BakeFacts& bake = facts.bake;
    if (bake.occluders.empty()) {
        dst.push_back(decision(effect, false, "none is given"));
        dst.back().impossible = "no --occluder is given";
    }
    for (const CasterReach& caster : bake.occluders) {
        const std::string what = count_text(caster.triangles, "triangle", "triangles");
        std::string reason = caster.verdict == CasterReach::too_far
            ? format("{}, {:.4g} away, and rays reach {:.4g}", what, caster.gap, bake.reach)
            : caster.verdict == CasterReach::below_horizon
            ? format("{}, all below the tangent plane of each of {}", what,
                     count_text(bake.triangles, "triangle", "triangles"))
            : format("{}, {:.4g} away, may rise above the horizon of a texel", what, caster.gap);
        const bool reaches = caster.verdict == CasterReach::reaches;
        dst.push_back(decision(effect, reaches, std::move(reason), trace_share(bake, caster.triangles)));
        dst.back().which = caster.name;
    }
}

void decide_ground(std::vector<EffectDecision>& dst, const Effect& effect, const EffectFacts& facts)
{
    const BakeFacts& bake = facts.bake;
    if (!bake.has_ground) {
        dst.push_back(decision(effect, false, "none is given"));
        dst.back().impossible = "no --ground is given";
        return;
    }
    const double below = bake.lowest - bake.ground_height;
    const bool reaches = below <= bake.reach;
    dst.push_back(decision(effect, reaches,
                           reaches ? format("the plane y = {:.4g}, {:.4g} below the mesh; no ray is traced for it",
                                            bake.ground_height, below)
                                   : format("the plane y = {:.4g} is {:.4g} below the mesh, and rays reach {:.4g}",
                                            bake.ground_height, below, bake.reach),
                           0.01));
}

void decide_cutouts(std::vector<EffectDecision>& dst, const Effect& effect, const EffectFacts& facts)
{
    const CutoutCounts& cutouts = facts.bake.cutouts;
    const double unknown = double(cutouts.unknown) / double(std::max<int64_t>(1, cutouts.cells));
    dst.push_back(
        decision(effect, cutouts.transparent + cutouts.mixed > 0,
                 cutouts.triangles == 0 ? std::string("no material has an opacity below 1")
                     : cutouts.opaque == cutouts.triangles
                     ? format("{}, opaque wherever a texture covers them",
                              count_text(cutouts.triangles, "triangle", "triangles"))
                     : format("{}: {} opaque, {} transparent, {} in part, where {} of the cells ask the texture",
                              count_text(cutouts.triangles, "triangle", "triangles"), cutouts.opaque,
                              cutouts.transparent, cutouts.mixed, percent_text(unknown)),
                 cutouts.mixed > 0 ? kFiltering : 0));
    if (cutouts.triangles == 0)
        dst.back().impossible = "no material has an opacity below 1";
}

void decide_normal_map(std::vector<EffectDecision>& dst, const Effect& effect, const EffectFacts& facts)
{
    const BakeFacts& bake = facts.bake;
    dst.push_back(decision(effect, bake.has_normal_map && !bake.has_flat_normal_map,
                           !bake.has_normal_map ? "none is given"
                               : bake.has_flat_normal_map && bake.has_material_normals
                               ? "no material names one that is not flat: every normal stays as it is"
                               : bake.has_flat_normal_map
                               ? "it is flat: every normal stays as it is"
                               : "normals of texels are mapped; rays into the surface are not traced",
                           0.02));
    if (!bake.has_normal_map)
        dst.back().impossible = "no --normal-map is given, and no --material-normals";
}

void decide_distance(std::vector<EffectDecision>& dst, const Effect& effect, const EffectFacts& facts)
{
    const BakeFacts& bake = facts.bake;
    const bool given = std::isfinite(bake.reach);
    const bool bounds = given && (bake.reach < bake.diagonal || bake.has_ground);
    dst.push_back(decision(
        effect, bounds,
        !given ? "none is given: rays end at the first thing they meet"
            : bounds
            ? format("rays end after {:.4g}, and the scene is {:.4g} across", bake.reach, bake.diagonal)
            : format("rays of {:.4g} cross the whole scene, which is {:.4g} across", bake.reach, bake.diagonal)));
    if (!given)
        dst.back().impossible = "no --max-distance is given";
}

void decide_poses(std::vector<EffectDecision>& dst, const Effect& effect, const EffectFacts& facts)
{
    const BakeFacts& bake = facts.bake;
    const std::string poses = count_text(bake.poses, "pose", "poses");
    dst.push_back(decision(
        effect, bake.poses > 1,
        bake.poses == 1           ? "one pose is given"
            : bake.pose_error < 0 ? format("{}, compared before the bake", poses)
            : bake.pose_error > 0
            ? format("{}; texels are traced again where V may change by more than {:.3g}", poses, bake.pose_error)
            : format("{}; texels are traced again where V may change", poses)));
    if (bake.poses == 1)
        dst.back().impossible = "one pose is given: give --frames or --pose";
}

void decide_udim(std::vector<EffectDecision>& dst, const Effect& effect, const EffectFacts& facts)
{
    const BakeFacts& bake = facts.bake;
    dst.push_back(decision(effect, bake.udim_given,
                           bake.udim_given ? format("tile {} of UV space", bake.udim)
                                           : std::string("no tile is given: [0, 1] of UV space is baked")));
    if (!bake.udim_given)
        dst.back().impossible = "no --udim is given";
}

void decide_margin(std::vector<EffectDecision>& dst, const Effect& effect, const EffectFacts& facts)
{
    const BakeFacts& bake = facts.bake;
    const int64_t empty = bake.texels - bake.covered;
    const std::string texels = count_text(bake.texels, "texel", "texels");
    dst.push_back(decision(effect, bake.margin != 0 && empty > 0,
                           bake.margin == 0      ? std::string("no margin is asked for")
                               : empty == 0      ? format("the mesh covers all of {}", texels)
                               : bake.margin < 0 ? format("{} of {} are empty, and all are filled", empty, texels)
                                                 : format("{} of {} are empty; those within {} of an island are filled",
                                                          empty, texels, bake.margin),
                           0.02));
    if (bake.margin == 0)
        dst.back().impossible = "the margin is 0";
}

void decide_half(std::vector<EffectDecision>& dst, const Effect& effect, const EffectFacts& facts)
{
    const BakeFacts& bake = facts.bake;
    dst.push_back(decision(effect, bake.half,
                           bake.half ? "--format half: V to 5e-4 of its value"
                                     : "--format float: every bit of the result is kept"));
    dst.back().impossible = bake.half ? "" : "give --format half";
}

void decide_color(std::vector<EffectDecision>& dst, const Effect& effect, const EffectFacts& facts)
{
    const LightFacts& light = facts.light;
    dst.push_back(decision(effect, light.converts_color,
                           light.converts_color ? light.color_note : "all inputs are in the space of the result",
                           0.02));
    if (!light.converts_color)
        dst.back().impossible = "there is nothing to convert";
}

void decide_rotation(std::vector<EffectDecision>& dst, const Effect& effect, const EffectFacts& facts)
{
    const double degrees = facts.light.rotation_degrees;
    dst.push_back(decision(effect, degrees > 0,
                           degrees > 0 ? format("the light is turned by {:.4g} degrees", degrees)
                                       : std::string("no rotation, or one that turns nothing"),
                           0.01));
}

void decide_albedo(std::vector<EffectDecision>& dst, const Effect& effect, const EffectFacts& facts)
{
    const LightFacts& light = facts.light;
    const bool is_one = light.albedo_low == 1 && light.albedo_high == 1;
    const bool called = light.has_albedo && !is_one;
    dst.push_back(decision(effect, called,
                           !light.has_albedo                          ? std::string("none is given")
                               : light.albedo_high < light.albedo_low ? std::string("one is given, and not read")
                               : is_one                               ? std::string("it is 1 everywhere")
                                        : format("values from {:.3g} to {:.3g}", light.albedo_low, light.albedo_high),
                           0.1));
    if (!light.has_albedo)
        dst.back().impossible = "no --albedo is given";
}

void decide_visibility(std::vector<EffectDecision>& dst, const Effect& effect, const EffectFacts& facts)
{
    const LightFacts& light = facts.light;
    const std::string lit = count_text(light.lit, "texel", "texels");
    dst.push_back(decision(effect, light.shadowed > 0,
                           light.shadowed > 0 ? format("V is below 1 in {} of {}", light.shadowed, lit)
                                              : format("V is 1 in all of {}: the light of the open sky", lit)));
}

void decide_bounce(std::vector<EffectDecision>& dst, const Effect& effect, const EffectFacts& facts)
{
    const LightFacts& light = facts.light;
    const bool called = light.wants_bounce && light.has_albedo && light.no_bounce.empty() && light.albedo_high > 0
        && light.shadowed > 0;
    dst.push_back(decision(effect, called,
                           !light.wants_bounce     ? std::string("not asked for: --bounce auto adds it")
                               : !light.has_albedo ? std::string("no albedo is given, so that nothing is sent back")
                               : !light.no_bounce.empty() ? light.no_bounce
                               : light.shadowed == 0      ? std::string("no texel sees a surface")
                               : !called                  ? std::string("the albedo is 0 everywhere")
                                                          : format("texels see surfaces that send back up to {:.3g} of "
                                                                                    "their light; {} rays a texel, once for all light",
                                                                   light.albedo_high, light.bounce_rays),
                           light.has_environment ? 0.15 : 0.5));
    if (!light.wants_bounce || !light.has_albedo || !light.no_bounce.empty())
        dst.back().impossible = dst.back().reason;
}

void decide_suns(std::vector<EffectDecision>& dst, const Effect& effect, const EffectFacts& facts)
{
    const LightFacts& light = facts.light;
    const bool called = light.wants_suns && light.no_suns.empty() && light.suns > 0;
    dst.push_back(decision(effect, called,
                           !light.wants_suns            ? std::string("not asked for: --suns auto adds them")
                               : !light.no_suns.empty() ? light.no_suns
                               : !called                ? std::string("the light has no small strong source")
                                         : format("{} with {} of the light; one ray or more for each texel that "
                                                  "faces them, at each rotation",
                                                  count_text(light.suns, "sun", "suns"), percent_text(light.sun_share)),
                           0.15));
    if (!light.wants_suns || !light.no_suns.empty())
        dst.back().impossible = dst.back().reason;
}

void decide_filter(std::vector<EffectDecision>& dst, const Effect& effect, const EffectFacts& facts)
{
    const LightFacts& light = facts.light;
    dst.push_back(decision(effect, light.has_environment && !light.is_one_color,
                           !light.has_environment   ? "the light is filtered already"
                               : light.is_one_color ? "the environment is of one colour, which no filter changes"
                                                    : "an environment is given",
                           0.35));
    if (!light.has_environment)
        dst.back().impossible = "the light is filtered already";
}

void decide_levels(std::vector<EffectDecision>& dst, const Effect& effect, const EffectFacts& facts)
{
    const LightFacts& light = facts.light;
    dst.push_back(
        decision(effect, light.levels > 1 && !light.is_one_color,
                 light.is_one_color     ? std::string("the light is of one colour: V times it, wherever texels look")
                     : light.levels > 1 ? format("the model {} reads {} images of the light", light.model, light.levels)
                                        : format("the model {} reads one image of the light", light.model),
                 0.2));
}

// Name, phrase, stage, can be off, decide.
constexpr Effect kEffects[] = {
    { "self-occlusion", "the mesh blocks its own rays", "vismap", true, decide_self_occlusion },
    { "occluders", "other meshes block rays", "vismap", true, decide_occluders },
    { "ground", "a horizontal plane blocks rays", "vismap", true, decide_ground },
    { "cut-outs", "light passes where materials are transparent", "vismap", true, decide_cutouts },
    { "normal-map", "texels have normals of their own", "vismap", true, decide_normal_map },
    { "max-distance", "what is far away blocks no ray", "vismap", true, decide_distance },
    { "poses", "the mesh deforms", "vismap", false, decide_poses },
    { "udim", "a tile of UV space other than the first", "vismap", false, decide_udim },
    { "margin", "texels around UV islands are filled", "vismap", true, decide_margin },
    { "half", "16 bits per channel", "vismap", false, decide_half },
    { "color-conversion", "inputs are brought to one colour space", "lightmap", false, decide_color },
    { "visibility", "part of the sky is hidden", "lightmap", false, decide_visibility },
    { "suns", "small strong lights throw shadows with edges", "lightmap", true, decide_suns },
    { "filter", "the environment is filtered by the cosine", "lightmap", false, decide_filter },
    { "stack-levels", "the light is read at several widths of the filter", "lightmap", false, decide_levels },
    { "rotation", "the light is turned", "lightmap", true, decide_rotation },
    { "albedo", "light is multiplied by a texture", "lightmap", true, decide_albedo },
    { "bounce", "surfaces light each other, once", "lightmap", true, decide_bounce },
};

} // namespace

OIIO::cspan<Effect> all_effects()
{
    return kEffects;
}

} // namespace vmlight
