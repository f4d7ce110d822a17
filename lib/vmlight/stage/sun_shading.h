// SPDX-License-Identifier: Apache-2.0
/// The suns of a lightmap: their shadows on the mesh or strands of its visibility map, traced for each rotation.
#pragma once

#include <vmlight/base/once_cache.h>
#include <vmlight/lightmap/sun_light.h>
#include <vmlight/stage/make_options.h>
#include <vmlight/stage/map_scene.h>
#include <vmlight/stage/recipe/chain.h>
#include <vmlight/stage/recipe/recipe.h>
#include <vmlight/stage/stored_suns.h>
#include <vmlight/stage/strand_sun_tracer.h>
#include <vmlight/vismap/sun_visibility.h>

#include <OpenImageIO/imageio.h>

#include <functional>
#include <memory>
#include <string>
#include <vector>

namespace vmlight {

class SunShading
{
public:
    /// @param recipe   with its UDIM tile resolved; its suns are not off
    /// @param vismap   the header of the visibility map
    /// @param scene    of that map
    /// @returns nullptr, with the location and reason in `error`, if there are neither a mesh nor channels `sun.N`
    static std::shared_ptr<SunShading> open(const LightmapRecipe& recipe, const OIIO::ImageSpec& vismap,
                                            std::shared_ptr<MapScene> scene, std::string& error,
                                            const RecipeChain& chain);

    /// Equal keys, equal shadows.
    const std::string& key() const { return m_key; }

    /// Reads a channel of the visibility map: one float for each pixel. False, with the reason in `error`, on failure.
    using ReadChannel = std::function<bool(int channel, std::vector<float>& dst, std::string& error)>;

    /// Trace `suns` at the rotation of `params`; or take their visibility from the map if it stores them all. Traces
    /// nothing if there are none.
    ///
    /// @param dst      set to their light; memory is reused
    /// @returns false, with the location and reason in `error`, if the mesh cannot be read or is not the one that was
    ///          baked, memory runs out, or the work was stopped
    bool light(SunLight& dst, const std::vector<Sun>& suns, const LightmapParams& params, const ReadChannel& read,
               const MakeOptions& options, std::string& error);

    bool failed() const;
    size_t bytes() const { return m_tracer.bytes() + m_strand_tracer.bytes(); }

private:
    bool read_stored(std::vector<float>& dst, const std::vector<int>& channels, const ReadChannel& read,
                     std::string& error) const;
    bool prepare(const MakeOptions& options, std::string& error);

    LightmapRecipe m_recipe;
    std::shared_ptr<MapScene> m_scene; ///< what to trace on
    StoredSuns m_stored;
    std::string m_key;
    RunOnce m_prepare;
    bool m_is_of_strands = false;
    SunTracer m_tracer;
    StrandSunTracer m_strand_tracer;
};

/// Of the inputs of a lightmap.
struct LightmapSuns
{
    std::vector<Sun> list; ///< in the colour of the light
    std::shared_ptr<SunShading> shading;
};

} // namespace vmlight
