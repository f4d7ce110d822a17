// SPDX-License-Identifier: Apache-2.0
/// What the texture of a surface holds: light of a model, or the numbers of its map as colours.
#pragma once

#include "renderer.h"

#include <string>
#include <vector>

namespace vmlight::view {

/// How mesh.frag draws what ViewParams::show asks for.
Show surface_show(const std::string& word);
/// Whether it is light, which goes through the display's view; colours of data do not.
bool is_light(const std::string& word);

/// Fill texture `slot` of a figure for what ViewParams::show asks for: light it by `params`, whose model may be `auto`,
/// on the graphics card, or by make_lightmap() where a model has no shader here. Models of surfaces leave strands to
/// the best of their own. A figure without a map is left as it is.
///
/// @returns false, with the reason in `error`, if the model lacks something, or the map the channel.
bool show_figure(Renderer& renderer, size_t figure, int slot, const std::string& word, const LightmapParams& params,
                 std::string& error);
/// The same of all of them.
bool show_surface(Renderer& renderer, int slot, const std::string& word, const LightmapParams& params,
                  std::string& error);

} // namespace vmlight::view
