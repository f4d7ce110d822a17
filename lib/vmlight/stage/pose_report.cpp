// SPDX-License-Identifier: Apache-2.0
#include <vmlight/stage/pose_report.h>

#include <vmlight/base/format.h>
#include <vmlight/base/stopwatch.h>
#include <vmlight/base/text_format.h>
#include <vmlight/mesh/same_triangles.h>
#include <vmlight/stage/bake_switches.h>
#include <vmlight/stage/normal_map_file.h>
#include <vmlight/stage/recipe/udim.h>
#include <vmlight/stage/scene_cache.h>
#include <vmlight/vismap/pose_ground.h>
#include <vmlight/vismap/pose_plan.h>
#include <vmlight/vismap/pose_proof.h>

#include <OpenImageIO/filesystem.h>

#include <algorithm>

namespace vmlight {
namespace {

std::string change_text(const PoseChange& change, double allowed)
{
    if (change.probes == 0)
        return "no texel traces a ray";
    return format(
        "V changes by at most {:.2g} in 99 % of the texels, and by {:.2g} at most; in {:.1f} % by more than {:.3g} "
        "({} looked at)",
        change.bound, change.most, 100 * change.above, allowed, count_text(change.probes, "texel", "texels"));
}

bool read_pose(PosedMap& dst, const VismapRecipe& given, const MakeOptions& options, std::string& error)
{
    const VismapRecipe recipe = with_switches(resolve_udim(given));
    SceneStamps stamps;
    std::string at;
    std::vector<std::string> ignored;
    return stamp_scene(stamps, recipe, at, error)
        && share_scene(dst.scene, recipe, stamps, options.threads, nullptr, at, error)
        && read_normal_map(dst.normal_map, recipe, { dst.scene, &dst.scene->mesh() }, options.threads, ignored, ignored,
                           error);
}

// What is looked at: all texels, with as many rays as are asked for.
VismapParams looking(VismapParams params)
{
    params.skip_open = false;
    params.target_error = 0;
    params.reconstruct = "off";
    params.channels.clear();
    return params;
}

// What of the map is bound to the axes, as a clause, or "".
std::string unturned_text(const VismapParams& params)
{
    const bool has_basis = params.basis == "mask" || params.basis == "cells", has_suns = !params.sun_directions.empty();
    return !has_basis && !has_suns ? ""
                                   : format("; {} must be baked again",
                                            has_basis && has_suns ? "its basis and its suns"
                                                : has_basis       ? "its basis"
                                                                  : "its suns");
}

bool report_change(PoseChange& change, const PosedMap& base, const VismapRecipe& recipe, double allowed,
                   const MakeOptions& options, std::string& error)
{
    PosedMap pose;
    if (!read_pose(pose, recipe, options, error))
        return false;
    error = triangles_fault(base.scene->mesh(), pose.scene->mesh());
    if (!error.empty())
        return false;
    const PoseMotion motion(*base.scene, *pose.scene);
    if (!motion.fault().empty()) {
        error = format("\"{}\": {}", recipe.mesh, motion.fault());
        return false;
    }
    const VismapParams params = looking(with_switches(recipe).vismap_params);
    const std::vector<uint8_t> same = prove_same_view(motion, params, false, options.threads);
    const bool is_turned = !is_straight(motion.turn(0));
    // Normals of an object-space map do not turn with the surface.
    const bool keeps_normals = have_same_normals(base.normal_map, pose.normal_map)
        && !(is_turned && pose.normal_map && pose.normal_map->is_object_space());
    if (std::find(same.begin(), same.end(), 0) == same.end() && keeps_normals
        && PoseGround(motion, params, 0).keeps_all()) {
        options.report(format("pose \"{}\": everything moves as one body: V stays, and B turns with it{}", recipe.mesh,
                              is_turned ? unturned_text(params) : ""));
        return true;
    }
    VismapBaker baker;
    if (!baker.prepare(pose.scene, params, error, options.threads, options.step("compare", 0, 0), 0, pose.normal_map))
        return false;
    if (!measure_change(change, { base, pose, motion, baker }, allowed, options.threads,
                        options.step("compare", 0, 0))) {
        error = "interrupted";
        return false;
    }
    options.report(format("pose \"{}\": {}", recipe.mesh, change_text(change, allowed)));
    return true;
}

} // namespace

void PoseTimes::add(const std::string& name, double seconds, const PoseChange& change)
{
    add(seconds,
        format("{}: compared in {:.2f} s; {} looked at", name, seconds, count_text(change.probes, "texel", "texels")));
}

void PoseTimes::add(const std::string& name, double seconds, const PoseReport& pose)
{
    add(seconds,
        format("{}: {:.2f} s; {}", name, seconds,
               pose.base.empty() ? "baked whole"
                                 : format("{:.1f} % of covered texels traced again",
                                          percent_of(pose.covered - pose.kept, pose.covered))));
}

void PoseTimes::add(double seconds, const std::string& line)
{
    m_seconds += seconds;
    m_lines.push_back("  " + line);
}

void PoseTimes::report(const MakeOptions& options) const
{
    if (m_lines.empty())
        return;
    options.report_answer(format("took, pose by pose, with their files: {:.2f} s", m_seconds));
    for (const std::string& line : m_lines)
        options.report_answer(line);
}

void report_pose(const PoseReport& pose, const MakeOptions& options)
{
    if (pose.base.empty()) {
        if (!pose.why.empty())
            options.report(format("pose: {}: baked whole; later poses are compared with it", pose.why));
        return;
    }
    const std::string traced = pose.kept == 0
        ? format("all texels are traced again, none is kept from {}", pose.base)
        : format("{:.1f} % of the texels are traced again, the others are kept from {}",
                 percent_of(pose.covered - pose.kept, pose.covered), pose.base);
    if (pose.change.probes > 0)
        options.report(format("pose: V changes by at most {:.2g} in 99 % of the texels that could be kept; {}",
                              pose.change.bound, traced));
    else
        options.report(
            format("pose: {}{}", pose.is_rigid && pose.kept > 0 ? "everything moves as one body; " : "", traced));
}

bool report_pose_changes(const VismapRecipe& recipe, const std::vector<VismapRecipe>& poses, double error_allowed,
                         PoseTimes& times, const MakeOptions& options, std::string& error)
{
    PosedMap base;
    if (!read_pose(base, recipe, options, error))
        return false;
    if (options.scene)
        *options.scene = base.scene; // the bake shares it
    return std::all_of(poses.begin(), poses.end(), [&](const VismapRecipe& pose) {
        const Stopwatch timer;
        PoseChange change;
        const bool done = report_change(change, base, pose, error_allowed, options, error);
        times.add(OIIO::Filesystem::filename(pose.mesh), timer(), change);
        return done;
    });
}

} // namespace vmlight
