// SPDX-License-Identifier: Apache-2.0
/// Bounced light of a lightmap: from which surfaces texels get it, traced once, and summed up for each light.
#pragma once

#include <vmlight/base/once_cache.h>
#include <vmlight/lightmap/bounce_light.h>
#include <vmlight/lightmap/input.h>
#include <vmlight/stage/make_options.h>
#include <vmlight/stage/map_scene.h>
#include <vmlight/stage/pixel_source.h>
#include <vmlight/stage/point_albedo.h>
#include <vmlight/stage/recipe/chain.h>
#include <vmlight/stage/recipe/recipe.h>
#include <vmlight/vismap/light_transport.h>
#include <vmlight/vismap/transport_forecast.h>

#include <OpenImageIO/imagebuf.h>

#include <memory>
#include <string>
#include <vector>

namespace vmlight {

/// Of one visibility map.
class BounceShading
{
public:
    /// @param recipe   with its UDIM tile resolved; its bounce is not off
    /// @param vismap   the visibility map
    /// @param light    the header of the filtered environment: its colour space is that of albedos
    /// @param scene    of the map, where rays may start anywhere
    /// @returns nullptr, with the location and reason in `error`, if there is no mesh or no albedo, or the OCIO config
    ///          is missing
    static std::shared_ptr<BounceShading> open(const LightmapRecipe& recipe, const PixelSource& vismap,
                                               const OIIO::ImageSpec& light, std::shared_ptr<MapScene> scene,
                                               std::string& error, const RecipeChain& chain);

    /// The same of a scene in memory, whose occluders have the albedo `color`.
    static std::shared_ptr<BounceShading> of(const BounceParams& params, std::shared_ptr<MapScene> scene,
                                             CasterColor color);

    /// Equal keys, equal surfaces.
    const std::string& key() const { return m_key; }

    /// Estimate what the first light() is going to trace, unless an earlier one has: nothing then.
    ///
    /// @param vismap   the pixels of the map
    /// @returns false, with the location and reason in `error`, as light()
    bool forecast(TransportForecast& dst, const OIIO::ImageBuf& vismap, const MakeOptions& options, std::string& error);

    /// Say in the metadata of a lightmap what was asked for.
    void tag(OIIO::ImageSpec& lightmap) const;

    /// Sum up the light that texels get from surfaces. The first call traces which those are, unless no texel can get
    /// any: V is 1 everywhere, or the albedo is 0.
    ///
    /// @param dst      set to the light; empty if no texel gets any
    /// @param vismap   the pixels of the map
    /// @param cfem     the images of the light that the model reads
    /// @param suns     nullptr, or of the same pixels, at the rotation of `params`
    /// @param albedo   opened for the pixels of the map
    /// @returns false, with the location and reason in `error`, if the mesh cannot be read or is not the one that was
    ///          baked, memory runs out, or the work was stopped
    bool light(BounceLight& dst, const OIIO::ImageBuf& vismap, OIIO::cspan<OIIO::ImageBuf> cfem, const SunLight* suns,
               const LightmapParams& params, const AlbedoReader& albedo, const MakeOptions& options,
               std::string& error);

    /// Whether that failed, or a file has changed since.
    bool failed() const
    {
        return m_prepare.failed() || m_scene->failed() || (m_prepare.succeeded() && !are_unchanged(m_albedo.files()));
    }
    size_t bytes() const { return m_transport.bytes() + m_points.capacity() * sizeof(float); }

private:
    TransportParams transport_params() const;
    bool prepare(const std::vector<float>& visibility, const MakeOptions& options, std::string& error);
    void warn_of_unused(const MakeOptions& options) const;
    bool light_points(std::vector<float>& dst, const OIIO::ImageBuf& vismap, OIIO::cspan<OIIO::ImageBuf> cfem,
                      const SunLight* suns, const LightmapParams& params, const MakeOptions& options,
                      std::string& error) const;

    LightmapRecipe m_recipe;
    std::string m_space; ///< interop id of the light's
    std::shared_ptr<MapScene> m_scene;
    CasterColor m_color; ///< empty: files say it
    std::string m_key;
    RunOnce m_prepare;
    LightTransport m_transport;
    PointAlbedo m_albedo;
    std::vector<float> m_points; ///< what bake_points() made of the transport's points
};

} // namespace vmlight
