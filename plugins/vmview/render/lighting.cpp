// SPDX-License-Identifier: Apache-2.0
#include "lighting.h"

#include "../scene/loading.h"
#include "false_color.h"

#include <vmlight/base/format.h>
#include <vmlight/base/oiio_compat.h>

namespace vmlight::view {

Show surface_show(const std::string& word)
{
    return word == "checker" ? Show::checker
        : word == "density"  ? Show::density
        : word == "lit"      ? Show::lit
                             : Show::colors;
}

bool is_light(const std::string& word)
{
    return word == "lit";
}

bool show_figure(Renderer& renderer, size_t figure, int slot, const std::string& word, const LightmapParams& params,
                 std::string& error)
{
    if (!renderer.map(figure))
        return true;
    const MapAsset& map = *renderer.map(figure);
    if (const FalseColor* color = find_false_color(word)) {
        const std::vector<float> rgb = false_color_image(map.image, *color);
        if (rgb.empty()) {
            error = renderer.mesh(figure)->is_strands()
                ? format("--show {}: maps of strands have no channel \"{}\"", word, color->channel)
                : format("the visibility map has no channel \"{}\"; bake it with makevismap --channels {}",
                         color->channel, color->channel);
            return false;
        }
        renderer.set_texture(slot, rgb.data(), false, figure);
        return true;
    }
    if (!is_light(word)) { // drawn from the UVs; the texture has the map's size
        renderer.set_texture(slot, std::vector<float>(3 * map.weights.size()).data(), false, figure);
        return true;
    }
    LightmapParams chosen = params;
    ShadingModel model;
    if (!model_for(model, params.model, map, *renderer.light(), error))
        return false;
    chosen.model = model.name;
    if (has_relight_shader(model.name))
        return renderer.relight(slot, chosen, error, figure);
    OIIO::ImageBuf lightmap;
    if (!make_lightmap(lightmap, map.image, renderer.light()->filtered(), chosen)) {
        error = oiio::error_line(lightmap);
        return false;
    }
    renderer.set_texture(slot, static_cast<const float*>(lightmap.localpixels()), true, figure);
    return true;
}

bool show_surface(Renderer& renderer, int slot, const std::string& word, const LightmapParams& params,
                  std::string& error)
{
    for (size_t figure = 0; figure < renderer.figures(); ++figure)
        if (!show_figure(renderer, figure, slot, word, params, error))
            return false;
    return true;
}

} // namespace vmlight::view
