// SPDX-License-Identifier: Apache-2.0
#include "assets.h"

#include <vmlight/base/format.h>
#include <vmlight/cfem/radiance.h>
#include <vmlight/frame/background.h>
#include <vmlight/frame/object_mesh.h>
#include <vmlight/frame/texel_weights.h>
#include <vmlight/image/channels.h>
#include <vmlight/mesh/import/importer.h>
#include <vmlight/mesh/import/strands/read_strands.h>
#include <vmlight/stage/make_stage.h>
#include <vmlight/stage/open_source.h>
#include <vmlight/uv/udim.h>

#include <array>

namespace vmlight::view {
namespace {

std::vector<float> weights_of(const OIIO::ImageBuf& map, const MeshAsset& mesh, int threads)
{
    if (!mesh.is_strands())
        return texel_weights(*mesh.mesh, map, mesh.recipe.vismap_params.udim, threads);
    const OIIO::ImageSpec& spec = map.spec();
    const StrandLayout& layout = mesh.strands.layout;
    std::vector<float> weights;
    for (int y = 0; y < spec.height; ++y)
        for (int x = 0; x < spec.width; ++x)
            weights.push_back(layout.strand_at(x, y) < layout.strands ? 1.0f : 0.0f);
    return weights;
}

} // namespace

bool read_map_image(OIIO::ImageBuf& dst, const std::string& path, const MakeOptions& options, std::string& error)
{
    LightmapRecipe recipe;
    recipe.vismap = path;
    const PixelSourcePointer source = open_input(recipe, "vismap", path, InputKind::Vismap, error, {});
    std::vector<OIIO::ImageBuf> images;
    std::array<int, 4> ignored;
    if (!source || !make_input(images, *source, {}, recipe, "vismap", path, options, error))
        return false;
    if (!find_vismap_channels(images[0].spec(), ignored, error)) {
        error = format("\"{}\": {}", path, error);
        return false;
    }
    if (kernel_of(images[0].spec()) == kStrandKernel) {
        error = format("\"{}\": a visibility map of strands, not of a mesh", path);
        return false;
    }
    dst = std::move(images[0]);
    return true;
}

MapPointer read_map_asset(const std::string& path, const MeshAsset& mesh, const MakeOptions& options,
                          std::string& error)
{
    OIIO::ImageBuf image;
    if (mesh.is_strands() ? !read_strand_map(image, mesh.strands, path, options, error)
                          : !read_map_image(image, udim_path(path, mesh.recipe.vismap_params.udim), options, error))
        return nullptr;
    if (!mesh.is_strands())
        warn_of_other_mesh(*mesh.mesh, mesh.recipe.mesh_params.uv_set, image.spec(), path, options);
    return make_map_asset(std::move(image), path, mesh, options.threads);
}

MapPointer make_map_asset(OIIO::ImageBuf image, const std::string& path, const MeshAsset& mesh, int threads)
{
    auto asset = std::make_shared<MapAsset>();
    asset->path = path;
    asset->image = std::move(image);
    asset->weights = weights_of(asset->image, mesh, threads);
    return asset;
}

MapPointer make_map_asset(OIIO::ImageBuf image, int samples, const MeshAsset& mesh, int threads)
{
    auto asset = std::make_shared<MapAsset>();
    asset->samples = samples;
    asset->image = std::move(image);
    asset->weights = weights_of(asset->image, mesh, threads);
    return asset;
}

LightPointer read_light_asset(const std::string& path, CfemRecipe recipe, double blur, const SpecularParams& specular,
                              const MakeOptions& options, std::string& error)
{
    auto asset = std::make_shared<LightAsset>();
    asset->path = path;
    recipe.stack = true;
    if (!asset->light.open(path, recipe, true, options, error))
        return nullptr;
    for (OIIO::ImageBuf& image : asset->light.filtered)
        image.specmod().erase_attribute(kSunsAttribute);
    asset->specular = specular.strand_specular;
    if (asset->specular > 0 && !filter_for_specular(asset->cones, asset->light, specular, options.threads, error))
        return nullptr;
    const OIIO::ImageBuf* seen
        = asset->light.environment.initialized() ? &asset->light.environment : find_radiance(asset->filtered());
    return !seen || make_background(asset->panorama, *seen, blur, options.threads, error) ? asset : nullptr;
}

AssetKind kind_of_file(const std::string& path, std::string& error)
{
    if (is_mesh_name(recipe_path(path)) || is_strand_file(path))
        return AssetKind::mesh;
    const std::string stage = image_stage(path);
    if (stage == kVismapStage)
        return AssetKind::map;
    if (stage == kLightmapStage) {
        error = format("\"{}\": a lit texture; open its mesh, its visibility map or an environment instead", path);
        return AssetKind::none;
    }
    const PixelSourcePointer source = open_source(path, error);
    if (!source)
        return AssetKind::none;
    std::array<int, 4> ignored;
    std::string no_map;
    return find_vismap_channels(source->spec(), ignored, no_map) ? AssetKind::map : AssetKind::light;
}

} // namespace vmlight::view
