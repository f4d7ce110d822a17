// SPDX-License-Identifier: Apache-2.0
#include <vmlight/stage/strand_source.h>

#include <vmlight/base/file_stamp.h>
#include <vmlight/base/format.h>
#include <vmlight/base/once_cache.h>
#include <vmlight/base/stopwatch.h>
#include <vmlight/base/text_format.h>
#include <vmlight/mesh/import/strands/read_strands.h>
#include <vmlight/trace/strand_scene.h>
#include <vmlight/vismap/strand_map.h>

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
            error = map.geterror();
            return false;
        }
        if (!m_occluder_hashes.empty())
            map.specmod().attribute("vmlight:occluderHash", m_occluder_hashes);
        const double seconds = timer() - build_seconds;
        options.report(format("strands: {} of {}, {}; each has {} along a row, from root to tip", m_strands.count(),
                              count_text(int64_t(m_strands.points.size()), "point", "points"),
                              count_text(m_scene.span_count(), "span", "spans"),
                              count_text(m_recipe.strand_params.strand_texels, "texel", "texels")));
        options.report(format("bake: {:.2f} M rays in {:.2f} s, {:.2f} M rays/s; build {:.2f} s", double(rays) * 1e-6,
                              seconds, double(rays) * 1e-6 / std::max(seconds, 1e-9), build_seconds));
        for (const std::string& warning : m_warnings)
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
        std::vector<Mesh> occluders(m_recipe.occluder.size());
        std::vector<FileStamp> files;
        std::string at;
        for (size_t i = 0; i < occluders.size(); ++i) {
            if (!read_scene_file(occluders[i], files, m_recipe, m_stamps, i + 1, options.steps(), at, error)) {
                error = with_location(m_recipe, at, options.chain, error);
                return false;
            }
            m_occluder_hashes += (i ? "," : "") + mesh_hash(occluders[i]);
            for (const std::string& warning : occluders[i].warnings)
                m_warnings.push_back(format("\"{}\": {}", occluders[i].path, warning));
        }
        if (!m_scene.build(m_strands, occluders, options.threads, error, options.steps())) {
            error = with_location(m_recipe, "mesh", options.chain, error);
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
    std::string m_occluder_hashes;
    std::vector<std::string> m_warnings;
    std::atomic<size_t> m_bytes { 0 };
};

} // namespace

PixelSourcePointer open_strand_map(const VismapRecipe& recipe, const std::string& key, SceneStamps stamps,
                                   const RecipeChain& chain, std::string& error)
{
    Strands strands;
    StrandLayout layout;
    std::vector<FileStamp> files;
    std::string at = "mesh";
    bool good = read_strands(strands, recipe.mesh, recipe.mesh_params, recipe.strand_params.radius, error,
                             [&](const std::string& path) { note_file(files, path); })
        && check_stamp(stamps.files[0], recipe.mesh, error);
    if (good) {
        at = "strand_texels";
        good = StrandLayout::make(layout, strands.count(), recipe.strand_params.strand_texels, error);
    }
    if (good)
        return std::make_shared<StrandSource>(key, recipe, std::move(stamps), std::move(strands), layout,
                                              std::move(files));
    error = with_location(recipe, at, chain, error);
    return nullptr;
}

} // namespace vmlight
