// SPDX-License-Identifier: Apache-2.0
/// The light of strands in a picture: the models that they have, the environment as they gather it, and suns.
#pragma once

#include <vmlight/frame/scene_light.h>
#include <vmlight/frame/strand_object.h>
#include <vmlight/lightmap/lightmap.h>
#include <vmlight/lightmap/sun_light.h>
#include <vmlight/stage/make_options.h>
#include <vmlight/trace/strand_scene.h>

#include <OpenImageIO/imagebuf.h>

#include <string>
#include <vector>

namespace vmlight {

/// The model to light strands with where `model` was asked for: that, or `auto` if it is of surfaces, or traces.
std::string strand_model(const std::string& model);

/// Why no strands, which were read from `path`, can be lit by `light`, or "": it is a filtered map without the rest.
std::string strand_light_fault(const SceneLight& light, const std::string& path);

/// The lobes of a stack as one for strands has them, which the models `ao` and `lobe` look up: the first is filtered
/// again. False, with the reason in `error`, if it cannot be filtered; `dst` is then as it was.
bool filter_for_strands(std::vector<OIIO::ImageBuf>& dst, const SceneLight& light, int nthreads, std::string& error);

/// The suns that texels of a map of strands see, traced for each rotation.
class StrandSuns
{
public:
    /// Trace those of `light` at the rotation of `params`, unless the last call did.
    ///
    /// @param object, scene, recipe    the same for all calls
    /// @returns false, with the reason in `error`: "interrupted" if it was stopped
    bool trace(const StrandObject& object, const StrandScene& scene, const VismapRecipe& recipe,
               const SceneLight& light, const LightmapParams& params, const MakeOptions& options, std::string& error);

    /// Of the last trace(), for make_lightmap().
    const SunLight& light() const { return m_light; }

private:
    std::string m_key; // what m_light was traced for
    SunLight m_light;
};

} // namespace vmlight
