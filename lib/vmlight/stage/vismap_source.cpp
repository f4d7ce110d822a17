// SPDX-License-Identifier: Apache-2.0
#include <vmlight/base/oiio_compat.h>
#include <vmlight/stage/make_stage.h>

#include <vmlight/base/format.h>
#include <vmlight/base/stopwatch.h>
#include <vmlight/stage/bake_forecast.h>
#include <vmlight/stage/bake_report.h>
#include <vmlight/stage/bake_switches.h>
#include <vmlight/stage/cutouts.h>
#include <vmlight/stage/large_map.h>
#include <vmlight/stage/map_parts.h>
#include <vmlight/stage/normal_map_file.h>
#include <vmlight/stage/open_source.h>
#include <vmlight/stage/pose_report.h>
#include <vmlight/stage/recipe/recipe_effects.h>
#include <vmlight/stage/recipe/strand_recipe.h>
#include <vmlight/stage/recipe/udim.h>
#include <vmlight/stage/scene_cache.h>
#include <vmlight/stage/source_cache.h>
#include <vmlight/stage/strand_source.h>
#include <vmlight/stage/vismap_metadata.h>
#include <vmlight/vismap/bake_parts.h>
#include <vmlight/vismap/baker.h>
#include <vmlight/vismap/pose_sequence.h>
#include <vmlight/vismap/reconstruct.h>
#include <vmlight/vismap/tiles.h>

#include <OpenImageIO/filesystem.h>

#include <algorithm>
#include <atomic>
#include <ctime>
#include <iterator>
#include <memory>

namespace vmlight {
namespace {

std::shared_ptr<const Mesh> mesh_of(const BakeScenePointer& scene)
{
    return { scene, &scene->mesh() };
}

void report_cutouts(const MakeOptions& options, const CutoutCounts& counts)
{
    if (options.repeated_inputs)
        return;
    if (const std::string line = cutout_line(counts); !line.empty())
        options.report(line);
    if (const std::string warning = cutout_warning(counts); !warning.empty())
        options.report_warning(warning);
}

class VismapSource : public PixelSource
{
public:
    VismapSource(const std::string& key, const VismapRecipe& recipe, SceneStamps stamps)
        : PixelSource(key)
        , m_given(recipe)
        , m_recipe(with_switches(recipe))
        , m_stamps(std::move(stamps))
    {
        // No mesh hash: computing it would mean reading the mesh in open().
        m_spec = describe_vismap(OIIO::Filesystem::filename(m_recipe.mesh), m_recipe.vismap_params);
        append_mesh_metadata(m_spec, m_recipe);
        append_no_reconstruct(m_spec, m_given);
    }

    bool read(OIIO::ROI roi, float* dst, std::string& error) override
    {
        if (!m_prepare.run([&](std::string& reason) { return prepare(reason); }, error))
            return false;
        m_tiles->read(roi, dst);
        return true;
    }

    // The whole map in one go: no tile cache, no overlapping margins.
    bool make(std::vector<OIIO::ImageBuf>& dst, ImageRange, const MakeOptions& options, std::string& error) override
    {
        Inputs inputs;
        if (!read_inputs(inputs, options, error))
            return false;
        const BakeWork before = BakeWork::so_far(*inputs.scene);
        dst.clear();
        OIIO::ImageBuf& map = dst.emplace_back();
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

    // The map from the top down.
    bool stream(const MapRows& rows, const MakeOptions& options, std::string& error)
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

    // Some parts of the map.
    bool make_parts(const PartRequest& request, const MakeOptions& options, std::string& error)
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

    // What make() would do, and take.
    bool report_plan(const MakeOptions& options, std::string& error)
    {
        const Stopwatch timer;
        const std::clock_t begin = std::clock();
        TimeTaken taken;
        BakeScenePointer scene;
        std::string at;
        if (!share_scene(scene, m_recipe, m_stamps, options.threads, nullptr, at, error, options.steps())) {
            error = with_location(m_recipe, at, options.chain, error);
            return false;
        }
        taken.read = timer();
        if (options.scene)
            *options.scene = scene;
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

    bool failed() const override
    {
        return m_prepare.failed() || (m_bytes && !(are_unchanged(m_scene->files) && are_unchanged(m_textures)));
    }
    // A shared scene is divided by the number of sharers, so that together they count it once.
    size_t bytes() const override
    {
        const size_t own = m_bytes;
        return own ? own + m_scene->bytes() / size_t(std::max<long>(1, m_scene.use_count())) : 0;
    }

private:
    struct Inputs
    {
        BakeScenePointer scene;
        NormalMapPointer normal_map;
        BakeForecast forecast; // if it is asked for
        double build_seconds = 0;
    };

    bool read_inputs(Inputs& dst, const MakeOptions& options, std::string& error) const
    {
        std::string at;
        if (!share_scene(dst.scene, m_recipe, m_stamps, options.threads, &dst.build_seconds, at, error,
                         options.steps())) {
            error = with_location(m_recipe, at, options.chain, error);
            return false;
        }
        if (options.scene)
            *options.scene = dst.scene;
        std::vector<std::string> notes, warnings;
        if (!read_normal_map(dst.normal_map, m_recipe, mesh_of(dst.scene), options.threads, notes, warnings, error)) {
            error = with_location(m_recipe, m_recipe.material_normals ? "material_normals" : "normal_map",
                                  options.chain, error);
            return false;
        }
        for (const std::string& note : notes)
            options.report(note);
        for (const std::string& warning : warnings)
            options.report_warning(warning);
        return (!options.explain && m_given.effects == "auto")
            || forecast_effects(dst.forecast, dst.scene, dst.normal_map, options, error);
    }

    MapJob job_of(const Inputs& inputs, const MakeOptions& options) const
    {
        return { inputs.scene,         m_recipe.vismap_params,
                 options.threads,      options.step("bake", m_spec.width, m_spec.height),
                 m_recipe.time_budget, inputs.normal_map,
                 options.steps() };
    }

    void tag(OIIO::ImageSpec& map, const BakeScene& scene) const
    {
        append_mesh_metadata(map, m_recipe);
        append_no_reconstruct(map, m_given);
        if (scene.occluder().cutouts().triangles > 0)
            append_params(map, m_recipe.cutout_params);
    }

    void report(const Inputs& inputs, VismapReport& report, const OIIO::ImageSpec& map,
                const MakeOptions& options) const
    {
        report.build_seconds += inputs.build_seconds;
        if (!options.repeated_inputs)
            for (const std::string& remark : inputs.scene->remarks)
                options.report(remark);
        report_bake(options, report, map, m_recipe, inputs.scene->mesh());
        report_cutouts(options, inputs.scene->occluder().cutouts());
    }

    bool forecast_effects(BakeForecast& dst, const BakeScenePointer& scene, const NormalMapPointer& normal_map,
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

    bool prepare(std::string& error)
    {
        std::string at;
        NormalMapPointer normal_map;
        std::vector<std::string> ignored;
        MakeOptions quiet;
        quiet.repeated_inputs = true; // whoever asks for tiles gets no warnings, so nothing is compared
        BakeForecast decided;
        if (!share_scene(m_scene, m_recipe, m_stamps, 0, nullptr, at, error)
            || !read_normal_map(normal_map, m_recipe, mesh_of(m_scene), 0, ignored, ignored, error, &m_textures)
            || (m_given.effects != "auto" && !forecast_effects(decided, m_scene, normal_map, quiet, error))
            || !m_baker.prepare(m_scene, m_recipe.vismap_params, error, 0, {}, 0, normal_map))
            return false;
        m_tiles = std::make_unique<VismapTiles>(m_baker, m_recipe.vismap_params.margin);
        if (m_tiles->is_whole())
            error = map_memory_shortage(m_spec, m_baker.params());
        if (!error.empty())
            return false;
        // This source owns the triangle lists, and the map if it was baked as a whole.
        const size_t lists = sizeof(uint32_t) * m_scene->mesh().triangles.size();
        m_bytes = 1 + lists + m_baker.seams().bytes() + (m_tiles->is_whole() ? size_t(m_spec.image_bytes()) : 0);
        return true;
    }

    const VismapRecipe m_given, m_recipe; // as written; and with its switches applied
    const SceneStamps m_stamps;
    RunOnce m_prepare;
    BakeScenePointer m_scene;
    std::vector<FileStamp> m_textures; // that materials name as normal maps
    VismapBaker m_baker;
    std::unique_ptr<VismapTiles> m_tiles;
    std::atomic<size_t> m_bytes { 0 }; // set last: nonzero means that everything else is ready
};

PixelSourcePointer open_mesh_map(const VismapRecipe& recipe, const std::string& key, SceneStamps stamps,
                                 const RecipeChain&, std::string&)
{
    return std::make_shared<VismapSource>(key, recipe, std::move(stamps));
}

bool bakes_mesh(const VismapRecipe&)
{
    return true;
}

/// What a recipe can bake: the first entry that says so.
struct BakedKind
{
    bool (*bakes)(const VismapRecipe& recipe);
    PixelSourcePointer (*open)(const VismapRecipe& recipe, const std::string& key, SceneStamps stamps,
                               const RecipeChain& chain, std::string& error);
};
constexpr BakedKind kBakedKinds[] = { { bakes_strands, open_strand_map }, { bakes_mesh, open_mesh_map } };

} // namespace

PixelSourcePointer open_source(const VismapRecipe& given, std::string& error, const RecipeChain& chain, Sharing sharing)
{
    const VismapRecipe recipe = resolve_udim(given), switched = with_switches(recipe);
    error = recipe_fault(recipe, chain);
    if (!error.empty() || !check_params(recipe.vismap_params, error) || !check_params(recipe.mesh_params, error)
        || !check_params(recipe.normal_map_params, error))
        return nullptr;
    SceneStamps stamps;
    std::string at;
    if (!stamp_scene(stamps, switched, at, error)) {
        error = with_location(recipe, at, chain, error);
        return nullptr;
    }
    std::string normal_map;
    if (!switched.normal_map.empty() && !stamp_file(normal_map, switched.normal_map, error)) {
        error = with_location(recipe, "normal_map", chain, error);
        return nullptr;
    }
    const std::string key = recipe_key(recipe) + stamps.key + normal_map;
    const bool shared = sharing == Sharing::process;
    if (PixelSourcePointer known = shared ? find_source(key) : nullptr)
        return known;
    const auto kind = std::find_if(std::begin(kBakedKinds), std::end(kBakedKinds),
                                   [&](const BakedKind& entry) { return entry.bakes(recipe); });
    const PixelSourcePointer source = kind->open(recipe, key, std::move(stamps), chain, error);
    return source && shared ? keep_source(source) : source;
}

bool forecast_vismap(const VismapRecipe& recipe, const MakeOptions& options, std::string& error)
{
    const PixelSourcePointer source = open_source(recipe, error, options.chain, Sharing::none);
    const auto vismap = std::dynamic_pointer_cast<VismapSource>(source);
    if (source && !vismap)
        error = "--dry-run: only bakes of meshes are forecast, not of strands";
    return vismap && vismap->report_plan(options, error);
}

bool make_vismap_parts(const VismapRecipe& recipe, const PartRequest& request, const MakeOptions& options,
                       std::string& error)
{
    const PixelSourcePointer source = open_source(recipe, error, options.chain, Sharing::none);
    const auto vismap = std::dynamic_pointer_cast<VismapSource>(source);
    return vismap && vismap->make_parts(request, options, error);
}

bool stream_vismap(const MapRows& rows, const VismapRecipe& recipe, const MakeOptions& options, std::string& error)
{
    const PixelSourcePointer source = open_source(recipe, error, options.chain, Sharing::none);
    const auto vismap = std::dynamic_pointer_cast<VismapSource>(source);
    return vismap && vismap->stream(rows, options, error);
}

} // namespace vmlight
