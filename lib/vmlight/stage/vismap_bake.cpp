// SPDX-License-Identifier: Apache-2.0
#include <vmlight/stage/vismap_bake.h>

#include <vmlight/base/format.h>
#include <vmlight/base/oiio_compat.h>
#include <vmlight/base/stopwatch.h>
#include <vmlight/stage/bake_report.h>
#include <vmlight/stage/bake_switches.h>
#include <vmlight/stage/cutouts.h>
#include <vmlight/stage/normal_map_file.h>
#include <vmlight/stage/pose_report.h>
#include <vmlight/stage/recipe/chain.h>
#include <vmlight/stage/recipe/recipe_effects.h>
#include <vmlight/stage/vismap_metadata.h>
#include <vmlight/vismap/bake_parts.h>
#include <vmlight/vismap/pose_sequence.h>

#include <OpenImageIO/filesystem.h>

#include <ctime>

namespace vmlight {
namespace {

void report_cutouts(const MakeOptions& options, const CutoutCounts& counts)
{
    if (options.repeated_inputs)
        return;
    if (const std::string line = cutout_line(counts); !line.empty())
        options.report(line);
    if (const std::string warning = cutout_warning(counts); !warning.empty())
        options.report_warning(warning);
}

} // namespace

struct VismapBake::Inputs
{
    BakeScenePointer scene;
    NormalMapPointer normal_map;
    BakeForecast forecast; // if it is asked for
    double build_seconds = 0;
};

VismapBake::VismapBake(const VismapRecipe& recipe, SceneStamps stamps)
    : m_given(recipe)
    , m_recipe(with_switches(recipe))
    , m_stamps(std::move(stamps))
    , m_spec(describe_vismap(OIIO::Filesystem::filename(m_recipe.mesh), m_recipe.vismap_params))
{
    append_mesh_metadata(m_spec, m_recipe);
    append_no_reconstruct(m_spec, m_given);
}

bool VismapBake::make(OIIO::ImageBuf& map, const MakeOptions& options, std::string& error) const
{
    Inputs inputs;
    if (!read_inputs(inputs, options, error))
        return false;
    const BakeWork before = BakeWork::so_far(*inputs.scene);
    const MapJob job = job_of(inputs, options);
    VismapReport report;
    PoseSequence* const poses
        = switches_of(m_given.effects, VismapRecipe::kStage).of("poses") == Switch::on ? nullptr : options.poses;
    if (!(poses ? poses->bake(map, job, options.pose, &report)
                : make_vismap(map, job.scene, job.params, &report, job.nthreads, job.progress, job.time_budget,
                              job.normal_map, job.at_step))) {
        error = oiio::error_line(map);
        return false;
    }
    tag(map.specmod(), *inputs.scene);
    this->report(inputs, report, map.spec(), options);
    if (poses)
        report_pose(poses->last(), options);
    if (options.explain)
        report_taken(inputs.forecast, report, before, *inputs.scene, options);
    return true;
}

bool VismapBake::stream(const MapRows& rows, const MakeOptions& options, std::string& error) const
{
    Inputs inputs;
    if (!read_inputs(inputs, options, error))
        return false;
    const BakeWork before = BakeWork::so_far(*inputs.scene);
    MapJob job = job_of(inputs, options);
    job.in_bands = true;
    OIIO::ImageSpec map;
    VismapReport report;
    const auto begin = [&](OIIO::ImageSpec& spec, std::string& reason) {
        tag(spec, *inputs.scene);
        map = spec;
        return rows.begin(spec, reason);
    };
    if (!stream_map({ begin, rows.take }, job, report, error))
        return false;
    this->report(inputs, report, map, options);
    if (options.explain)
        report_taken(inputs.forecast, report, before, *inputs.scene, options);
    return true;
}

bool VismapBake::make_parts(const PartRequest& request, const MakeOptions& options, std::string& error) const
{
    Inputs inputs;
    if (!read_inputs(inputs, options, error))
        return false;
    PartsJob job { job_of(inputs, options), request.count, request.parts, {}, request.is_made, request.write };
    job.tag = [&](OIIO::ImageSpec& map) { tag(map, *inputs.scene); };
    VismapReport report;
    if (!bake_parts(job, report, error))
        return false;
    this->report(inputs, report, m_spec, options);
    return true;
}

bool VismapBake::report_plan(const MakeOptions& options, std::string& error) const
{
    const Stopwatch timer;
    const std::clock_t begin = std::clock();
    TimeTaken taken;
    BakeScenePointer scene;
    if (!read_scene(scene, nullptr, options, error))
        return false;
    taken.read = timer();
    NormalMapPointer normal_map;
    std::vector<std::string> ignored;
    BakeForecast forecast;
    if (!read_normal_map(normal_map, m_recipe, mesh_of(scene), options.threads, ignored, ignored, error)
        || !forecast_effects(forecast, scene, normal_map, options, error))
        return false;
    taken.processor = double(std::clock() - begin) / CLOCKS_PER_SEC;
    report_forecast(forecast, m_recipe, taken, options);
    return true;
}

bool VismapBake::read_scene(BakeScenePointer& dst, double* built, const MakeOptions& options, std::string& error) const
{
    std::string at;
    if (!share_scene(dst, m_recipe, m_stamps, options.threads, built, at, error, options.steps())) {
        error = with_location(m_recipe, at, options.chain, error);
        return false;
    }
    if (options.scene)
        *options.scene = dst;
    return true;
}

bool VismapBake::read_inputs(Inputs& dst, const MakeOptions& options, std::string& error) const
{
    if (!read_scene(dst.scene, &dst.build_seconds, options, error))
        return false;
    std::vector<std::string> notes, warnings;
    if (!read_normal_map(dst.normal_map, m_recipe, mesh_of(dst.scene), options.threads, notes, warnings, error)) {
        error = with_location(m_recipe, m_recipe.material_normals ? "material_normals" : "normal_map", options.chain,
                              error);
        return false;
    }
    for (const std::string& note : notes)
        options.report(note);
    for (const std::string& warning : warnings)
        options.report_warning(warning);
    return (!options.explain && m_given.effects == "auto")
        || forecast_effects(dst.forecast, dst.scene, dst.normal_map, options, error);
}

MapJob VismapBake::job_of(const Inputs& inputs, const MakeOptions& options) const
{
    return { inputs.scene,         m_recipe.vismap_params,
             options.threads,      options.step("bake", m_spec.width, m_spec.height),
             m_recipe.time_budget, inputs.normal_map,
             options.steps() };
}

void VismapBake::tag(OIIO::ImageSpec& map, const BakeScene& scene) const
{
    append_mesh_metadata(map, m_recipe);
    append_no_reconstruct(map, m_given);
    if (scene.occluder().cutouts().triangles > 0)
        append_params(map, m_recipe.cutout_params);
}

void VismapBake::report(const Inputs& inputs, VismapReport& report, const OIIO::ImageSpec& map,
                        const MakeOptions& options) const
{
    report.build_seconds += inputs.build_seconds;
    if (!options.repeated_inputs)
        for (const std::string& remark : inputs.scene->remarks)
            options.report(remark);
    report_bake(options, report, map, m_recipe, inputs.scene->mesh());
    report_cutouts(options, inputs.scene->occluder().cutouts());
}

bool VismapBake::forecast_effects(BakeForecast& dst, const BakeScenePointer& scene, const NormalMapPointer& normal_map,
                                  const MakeOptions& options, std::string& error) const
{
    const SceneOf scene_of = [&](BakeScenePointer& other, const VismapRecipe& recipe, std::string& reason) {
        const VismapRecipe switched = with_switches(recipe);
        SceneStamps stamps;
        std::string at;
        return stamp_scene(stamps, switched, at, reason)
            && share_scene(other, switched, stamps, options.threads, nullptr, at, reason);
    };
    if (forecast_bake(dst, scene, normal_map, m_given, scene_of, options, error))
        return true;
    error = options.chain.empty() ? error : format("\"{}\": {}", options.chain.back(), error);
    return false;
}

} // namespace vmlight
