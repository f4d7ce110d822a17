// SPDX-License-Identifier: Apache-2.0
/// Light a visibility map on the graphics card, with the arithmetic of make_lightmap().
#pragma once

#include "light_textures.h"
#include "lit_texture.h"
#include "map_textures.h"

#include <vmlight/lightmap/lightmap.h>

#include <OpenImageIO/imagebuf.h>

#include <string>

namespace vmlight::view {

/// Whether a model (a word of LightmapParams::model) has a shader here; the others are left to make_lightmap().
bool has_relight_shader(const std::string& model);

class RelightPass
{
public:
    bool build(std::string& error);

    /// Light `map`, and make the mip levels.
    ///
    /// @param radiance the last image of the stack, for `sh`; else unused
    /// @param added    nullptr, or light besides that of the model, R, G, B of the size of `map`, before the exposure
    /// @param params   its model must be one that has_relight_shader() and that map and light allow (choose_model())
    /// @returns false, with the reason in `error`, if a parameter is out of range.
    bool run(LitTexture& dst, const MapTextures& map, const LightTextures& light, const OIIO::ImageBuf* radiance,
             const Texture* added, const LightmapParams& params, std::string& error) const;
    /// Make the mip levels of a texture that was filled otherwise.
    void finish(const LitTexture& dst) const { m_pyramid.run(dst); }

private:
    bool set_harmonics(const MapTextures& map, const OIIO::ImageBuf& radiance, const Rotation& rotation, float gain,
                       std::string& error) const;

    Program m_cfem, m_lobe, m_sh;
    Texture m_none; // where nothing is added: drivers want each sampler to have a texture
    PyramidPass m_pyramid;
};

} // namespace vmlight::view
