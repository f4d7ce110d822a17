// SPDX-License-Identifier: Apache-2.0
#include <vmlight/stage/make_stage.h>

#include <vmlight/base/format.h>
#include <vmlight/stage/bake_switches.h>
#include <vmlight/stage/large_map.h>
#include <vmlight/stage/normal_map_file.h>
#include <vmlight/stage/open_source.h>
#include <vmlight/stage/recipe/strand_recipe.h>
#include <vmlight/stage/recipe/udim.h>
#include <vmlight/stage/source_cache.h>
#include <vmlight/stage/strand_source.h>
#include <vmlight/stage/vismap_bake.h>
#include <vmlight/vismap/baker.h>
#include <vmlight/vismap/tiles.h>

#include <algorithm>
#include <atomic>
#include <iterator>
#include <memory>

namespace vmlight {
namespace {

class VismapSource : public PixelSource
{
public:
    VismapSource(const std::string& key, const VismapRecipe& recipe, SceneStamps stamps)
        : PixelSource(key)
        , m_bake(recipe, std::move(stamps))
    {
        m_spec = m_bake.spec();
    }

    const VismapBake& bake() const { return m_bake; }

    bool read(OIIO::ROI roi, float* dst, std::string& error) override
    {
        if (!m_prepare.run([&](std::string& reason) { return prepare(reason); }, error))
            return false;
        m_tiles->read(roi, dst);
        return true;
    }

    bool make(std::vector<OIIO::ImageBuf>& dst, ImageRange, const MakeOptions& options, std::string& error) override
    {
        dst.clear();
        return m_bake.make(dst.emplace_back(), options, error);
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
    bool prepare(std::string& error)
    {
        const VismapRecipe& recipe = m_bake.recipe();
        std::string at;
        NormalMapPointer normal_map;
        std::vector<std::string> ignored;
        MakeOptions quiet;
        quiet.repeated_inputs = true; // whoever asks for tiles gets no warnings, so nothing is compared
        BakeForecast decided;
        if (!share_scene(m_scene, recipe, m_bake.stamps(), 0, nullptr, at, error)
            || !read_normal_map(normal_map, recipe, mesh_of(m_scene), 0, ignored, ignored, error, &m_textures)
            || (m_bake.given().effects != "auto"
                && !m_bake.forecast_effects(decided, m_scene, normal_map, quiet, error))
            || !m_baker.prepare(m_scene, recipe.vismap_params, error, 0, {}, 0, normal_map))
            return false;
        m_tiles = std::make_unique<VismapTiles>(m_baker, recipe.vismap_params.margin);
        if (m_tiles->is_whole())
            error = map_memory_shortage(m_spec, m_baker.params());
        if (!error.empty())
            return false;
        // This source owns the triangle lists, and the map if it was baked as a whole.
        const size_t lists = sizeof(uint32_t) * m_scene->mesh().triangles.size();
        m_bytes = 1 + lists + m_baker.seams().bytes() + (m_tiles->is_whole() ? size_t(m_spec.image_bytes()) : 0);
        return true;
    }

    const VismapBake m_bake;
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

namespace {

// Of a recipe with a mesh: nullptr, with the reason in `error`, for strands.
std::shared_ptr<VismapSource> open_mesh_bake(const VismapRecipe& recipe, const MakeOptions& options, std::string& error)
{
    const PixelSourcePointer source = open_source(recipe, error, options.chain, Sharing::none);
    const auto vismap = std::dynamic_pointer_cast<VismapSource>(source);
    if (source && !vismap)
        error = format("\"{}\" has strands: parts and forecasts only work for meshes", recipe.mesh);
    return vismap;
}

} // namespace

bool forecast_vismap(const VismapRecipe& recipe, const MakeOptions& options, std::string& error)
{
    const auto vismap = open_mesh_bake(recipe, options, error);
    return vismap && vismap->bake().report_plan(options, error);
}

bool make_vismap_parts(const VismapRecipe& recipe, const PartRequest& request, const MakeOptions& options,
                       std::string& error)
{
    const auto vismap = open_mesh_bake(recipe, options, error);
    return vismap && vismap->bake().make_parts(request, options, error);
}

bool stream_vismap(const MapRows& rows, const VismapRecipe& recipe, const MakeOptions& options, std::string& error)
{
    const auto vismap = open_mesh_bake(recipe, options, error);
    return vismap && vismap->bake().stream(rows, options, error);
}

} // namespace vmlight
