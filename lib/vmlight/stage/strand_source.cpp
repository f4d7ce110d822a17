// SPDX-License-Identifier: Apache-2.0
#include <vmlight/stage/strand_source.h>

#include <vmlight/base/file_stamp.h>
#include <vmlight/base/format.h>
#include <vmlight/base/oiio_compat.h>
#include <vmlight/base/once_cache.h>
#include <vmlight/base/stopwatch.h>
#include <vmlight/base/text_format.h>
#include <vmlight/stage/strand_files.h>

#include <OpenImageIO/filesystem.h>

#include <algorithm>
#include <atomic>
#include <memory>
#include <utility>
#include <vector>

namespace vmlight {
namespace {

class StrandSource : public PixelSource
{
public:
    StrandSource(const std::string& key, const VismapRecipe& recipe, SceneStamps stamps, Strands strands,
                 const StrandLayout& layout, std::vector<FileStamp> files)
        : PixelSource(key)
        , m_recipe(recipe)
        , m_stamps(std::move(stamps))
        , m_strands(std::move(strands))
        , m_files(std::move(files))
        , m_baker(m_strands, m_scene, layout, recipe.vismap_params)
    {
        m_spec = describe_strand_map(m_strands, layout, recipe.strand_params, recipe.vismap_params);
        const VismapRecipe whole;
        if (recipe.mesh_params.up != whole.mesh_params.up)
            m_spec.attribute(metadata_name("up"), recipe.mesh_params.up);
        if (recipe.cutout_params.cutouts != whole.cutout_params.cutouts)
            m_spec.attribute(metadata_name("cutouts"), recipe.cutout_params.cutouts);
    }

    bool read(OIIO::ROI roi, float* dst, std::string& error) override
    {
        if (!prepare({}, error))
            return false;
        m_baker.bake(roi, dst);
        return true;
    }

    bool make(std::vector<OIIO::ImageBuf>& dst, ImageRange, const MakeOptions& options, std::string& error) override
    {
        if (options.explain || options.dry_run) {
            error = "--explain and --dry-run are for meshes: nothing is decided about strands";
            return false;
        }
        const Stopwatch timer;
        if (!prepare(options, error))
            return false;
        const double build_seconds = timer();
        int64_t rays = 0;
        dst.clear();
        OIIO::ImageBuf& map = dst.emplace_back();
        if (!make_strand_map(map, m_spec, m_baker, options.threads, rays,
                             options.step("bake", m_spec.width, m_spec.height))) {
            error = oiio::error_line(map);
            return false;
        }
        if (!m_facts.occluder_hashes.empty()) {
            map.specmod().attribute("vmlight:occluderHash", m_facts.occluder_hashes);
            map.specmod().attribute("vmlight:occluder", m_facts.occluder_names);
        }
        const double seconds = timer() - build_seconds;
        options.report(format("strands: {} of {}, {}; each has {} along a row, from root to tip", m_strands.count(),
                              count_text(int64_t(m_strands.points.size()), "point", "points"),
                              count_text(m_scene.span_count(), "span", "spans"),
                              count_text(m_recipe.strand_params.strand_texels, "texel", "texels")));
        options.report(format("bake: {:.2f} M rays in {:.2f} s, {:.2f} M rays/s; build {:.2f} s", double(rays) * 1e-6,
                              seconds, double(rays) * 1e-6 / std::max(seconds, 1e-9), build_seconds));
        for (const std::string& warning : m_facts.warnings)
            options.report_warning(warning);
        return true;
    }

    bool failed() const override { return m_prepare.failed() || !are_unchanged(m_files); }
    size_t bytes() const override { return m_bytes; }

private:
    bool prepare(const MakeOptions& options, std::string& error)
    {
        return m_prepare.run([&](std::string& reason) { return build(options, reason); }, error);
    }

    bool build(const MakeOptions& options, std::string& error)
    {
        std::string at;
        if (const std::string warning = thick_strands_warning(m_strands); !warning.empty())
            options.report_warning(format("\"{}\": {}", m_recipe.mesh, warning)); // before the bake, which may be long
        if (!build_strand_scene(m_scene, m_facts, m_strands, m_recipe, m_stamps, options, at, error)) {
            error = with_location(m_recipe, at, options.chain, error);
            return false;
        }
        m_bytes = m_scene.bytes() + m_strands.points.size() * (sizeof(Imath::V3d) + sizeof(double));
        return true;
    }

    const VismapRecipe m_recipe;
    const SceneStamps m_stamps;
    const Strands m_strands;
    const std::vector<FileStamp> m_files; // of the strands
    StrandScene m_scene;
    const StrandBaker m_baker; // refers to m_scene
    RunOnce m_prepare;
    StrandSceneFacts m_facts;
    std::atomic<size_t> m_bytes { 0 };
};

} // namespace

PixelSourcePointer open_strand_map(const VismapRecipe& recipe, const std::string& key, SceneStamps stamps,
                                   const RecipeChain& chain, std::string& error)
{
    Strands strands;
    StrandLayout layout;
    std::vector<FileStamp> files;
    std::string at;
    if (read_strand_file(strands, layout, files, recipe, stamps, at, error))
        return std::make_shared<StrandSource>(key, recipe, std::move(stamps), std::move(strands), layout,
                                              std::move(files));
    error = with_location(recipe, at, chain, error);
    return nullptr;
}

} // namespace vmlight
