// SPDX-License-Identifier: Apache-2.0
#include <vmlight/effects/rows.h>

#include <vmlight/base/format.h>
#include <vmlight/base/text_format.h>
#include <vmlight/vismap/neighbour_weights.h>

#include <algorithm>
#include <cmath>

namespace vmlight {
namespace {

// What tracing takes, relative to all else that a texel does, which kStage of decide.cpp stands for.
constexpr double kTracing = 0.85;
// What asking at triangles that are transparent in part adds to tracing, and what those hits add that ask the texture:
// bench/cutout_bench.cpp.
constexpr double kAsking = 0.3, kTexture = 0.5;
// What averaging neighbours takes beside a bake of 64 rays.
constexpr double kAveraging = 0.06;

// How deep rays go into so many triangles.
double depth(int64_t triangles)
{
    return std::log2(2.0 + double(triangles));
}

double tracing(const BakeFacts& facts)
{
    return kTracing * (1 - facts.open_share);
}

// The part of tracing that a mesh has among those that rays may meet.
double tracing(const BakeFacts& facts, int64_t triangles)
{
    double all = depth(facts.triangles);
    for (const CasterReach& caster : facts.occluders)
        if (caster.verdict == CasterReach::reaches)
            all += depth(caster.triangles + caster.spans);
    return tracing(facts) * depth(triangles) / all;
}

} // namespace

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
                               tracing(bake, bake.triangles)));
    else
        dst.push_back(
            decision(effect, true,
                     bake.proven ? format("something rises above each of {}", triangles)
                                 : format("{}, blocked by each other or by occluders; the few that may be free are not "
                                          "worth a search",
                                          triangles),
                     tracing(bake, bake.triangles)));
}

void decide_occluders(std::vector<EffectDecision>& dst, const Effect& effect, const EffectFacts& facts)
{
    const BakeFacts& bake = facts.bake;
    if (bake.occluders.empty()) {
        dst.push_back(decision(effect, false, "none is given"));
        dst.back().impossible = "no --occluder is given";
    }
    for (const CasterReach& caster : bake.occluders) {
        const std::string what = caster.strands > 0 ? count_text(caster.strands, "strand", "strands")
                                                    : count_text(caster.triangles, "triangle", "triangles");
        std::string reason = caster.verdict == CasterReach::too_far
            ? format("{}, {:.4g} away, and rays reach {:.4g}", what, caster.gap, bake.reach)
            : caster.verdict == CasterReach::below_horizon
            ? format("{}, all below the tangent plane of each of {}", what,
                     count_text(bake.triangles, "triangle", "triangles"))
            : format("{}, {:.4g} away, may rise above the horizon of a texel", what, caster.gap);
        const bool reaches = caster.verdict == CasterReach::reaches;
        dst.push_back(decision(effect, reaches, std::move(reason), tracing(bake, caster.triangles + caster.spans)));
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
    const bool is_hidden = bake.faces_up && below >= 0, reaches = below <= bake.reach;
    const std::string place = below > 0 ? format("is {:.4g} below the mesh", below)
        : below < 0                     ? format("is {:.4g} above the lowest point of the mesh", -below)
                                        : std::string("touches the mesh");
    dst.push_back(decision(effect, reaches && !is_hidden,
                           format("the plane y = {:.4g} {}{}", bake.ground_height, place,
                                  is_hidden      ? ", and every texel faces straight up"
                                      : !reaches ? format(", and rays reach {:.4g}", bake.reach)
                                                 : "; no ray is traced for it"),
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
                     : format("{}: {} opaque, {} transparent, {} in part, where {} of the cells need the texture",
                              count_text(cutouts.triangles, "triangle", "triangles"), cutouts.opaque,
                              cutouts.transparent, cutouts.mixed, percent_text(unknown)),
                 cutouts.mixed > 0 ? tracing(facts.bake) * (kAsking + kTexture * unknown) : 0));
    if (facts.bake.no_cutouts)
        dst.back().impossible = dst.back().reason = "cutouts is off: every material is opaque";
    else if (cutouts.triangles == 0)
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
    const double reach = bake.given_reach;
    const bool given = std::isfinite(reach);
    const bool bounds = given && (reach < bake.diagonal || bake.has_ground);
    dst.push_back(decision(
        effect, bounds,
        !given       ? "none is given: rays end at the first thing they meet"
            : bounds ? format("rays end after {:.4g}, and the scene is {:.4g} across", reach, bake.diagonal)
                     : format("rays of {:.4g} cross the whole scene, which is {:.4g} across", reach, bake.diagonal)));
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

void decide_reconstruction(std::vector<EffectDecision>& dst, const Effect& effect, const EffectFacts& facts)
{
    const BakeFacts& bake = facts.bake;
    const bool is_open = bake.open_triangles == bake.triangles && !bake.has_ground;
    const std::string texels = count_text(bake.covered, "texel", "texels");
    dst.push_back(decision(
        effect, bake.no_reconstruct.empty() && !is_open,
        !bake.no_reconstruct.empty() ? format("{}: each of {} has what its own rays see", bake.no_reconstruct, texels)
            : is_open                ? format("nothing blocks a ray of any of {}", texels)
                      : format("each of {} is averaged with those of the {} around it that see the same", texels,
                               NeighbourWindow::kNeighbours),
        kAveraging));
    dst.back().impossible = bake.no_reconstruct;
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

} // namespace vmlight
