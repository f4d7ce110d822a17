// SPDX-License-Identifier: Apache-2.0
#include <vmlight/stage/sun_choice.h>

#include <vmlight/base/format.h>
#include <vmlight/image/channels.h>
#include <vmlight/math/latlong.h>
#include <vmlight/stage/lightmap_images.h>
#include <vmlight/stage/stored_suns.h>
#include <vmlight/stage/sun_source.h>

#include <algorithm>
#include <array>

namespace vmlight {
namespace {

std::string why_no_part(const OIIO::ImageSpec& vismap, const std::string& name)
{
    return OIIO::get_roi(vismap) == OIIO::get_roi_full(vismap) ? "" : format("\"{}\" is only a part of a map", name);
}

} // namespace

std::string why_no_mesh(const LightmapRecipe& recipe, const std::string& name)
{
    return recipe_stage(recipe.vismap) == VismapRecipe::kStage || !recipe.mesh.empty()
        ? ""
        : format("\"{}\" does not store its mesh: set --mesh, and --occluder for each mesh that occluded it", name);
}

std::string why_no_trace(const LightmapRecipe& recipe, const OIIO::ImageSpec& vismap, const std::string& name)
{
    const std::string reason = why_no_mesh(recipe, name);
    return reason.empty() ? why_no_part(vismap, name) : reason;
}

std::string why_no_bounce(const LightmapRecipe& recipe, const OIIO::ImageSpec& vismap, const std::string& name)
{
    return recipe.albedo.empty() ? "it needs an albedo: set --albedo" : why_no_trace(recipe, vismap, name);
}

std::string why_no_suns(const LightmapRecipe& recipe, const OIIO::ImageSpec& vismap, const std::string& name)
{
    return stored_suns(vismap).empty() ? why_no_trace(recipe, vismap, name) : why_no_part(vismap, name);
}

bool suns_of_light(std::vector<Sun>& dst, const LightmapRecipe& recipe, std::string& error, const RecipeChain& chain)
{
    dst.clear();
    LightmapRecipe split = recipe;
    split.suns = "auto";
    LightmapImages images;
    std::string text;
    return open_images(images, split, error, chain)
        && (images.suns == nullptr || (find_suns(text, *images.cfem, error) && parse_suns(dst, text, error)));
}

double sun_share(const std::vector<Sun>& suns, const OIIO::ImageBuf& light, bool is_rest)
{
    std::array<int, 3> index;
    std::string ignored;
    const OIIO::ImageSpec& spec = light.spec();
    if (suns.empty() || !light.localpixels() || !find_color_channels(spec, index, ignored))
        return 0;
    // Irradiance / pi on a surface that faces a sun; that of a sphere of light is its mean radiance over it.
    double narrow = 0;
    for (const Sun& sun : suns)
        narrow += (sun.color[0] + sun.color[1] + sun.color[2]) / 4;
    double all = is_rest ? narrow : 0;
    const auto* pixel = static_cast<const float*>(light.localpixels());
    for (int y = 0; y < spec.height; ++y) {
        double row = 0;
        for (int x = 0; x < spec.width; ++x, pixel += spec.nchannels)
            row += double(pixel[index[0]]) + double(pixel[index[1]]) + double(pixel[index[2]]);
        all += row * latlong::row_solid_angle(y, spec.height) / (4 * latlong::pi * spec.width);
    }
    return all > 0 ? std::min(1.0, narrow / all) : 0;
}

} // namespace vmlight
