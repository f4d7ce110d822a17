// SPDX-License-Identifier: Apache-2.0
#include <vmlight/stage/sun_choice.h>

#include <vmlight/base/format.h>
#include <vmlight/image/channels.h>
#include <vmlight/math/latlong.h>
#include <vmlight/stage/lightmap_images.h>
#include <vmlight/stage/sun_source.h>
#include <vmlight/vismap/sun_visibility.h>

#include <algorithm>
#include <array>

namespace vmlight {

std::string why_no_trace(const LightmapRecipe& recipe, const OIIO::ImageSpec& vismap)
{
    if (recipe_stage(recipe.vismap) != VismapRecipe::kStage && recipe.mesh.empty())
        return format("\"{}\" does not say where its mesh is; set --mesh, and --occluder for all else that occluded it",
                      recipe.vismap);
    if (OIIO::get_roi(vismap) != OIIO::get_roi_full(vismap))
        return format("\"{}\" is only a part of a map", recipe.vismap);
    return "";
}

std::string why_no_suns(const LightmapRecipe& recipe, const OIIO::ImageSpec& vismap)
{
    const std::vector<std::string> stored = sun_channels(vismap.get_string_attribute("vmlight:sun_directions"));
    const bool has_stored = !stored.empty() && std::all_of(stored.begin(), stored.end(), [&](const std::string& name) {
        return vismap.channelindex(name) >= 0;
    });
    LightmapRecipe known = recipe;
    if (has_stored && recipe.mesh.empty())
        known.mesh = "its own channels";
    return why_no_trace(known, vismap);
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
