// SPDX-License-Identifier: Apache-2.0
/// Shading by region: make_lightmap() shades a whole map, a reader the tiles that are asked for. Neither the order nor
/// the shape of regions changes a bit.
#pragma once

#include <vmlight/base/bad_values.h>
#include <vmlight/lightmap/bounce_light.h>
#include <vmlight/lightmap/input.h>
#include <vmlight/lightmap/lightmap.h>
#include <vmlight/lightmap/model.h>
#include <vmlight/lightmap/sun_light.h>

#include <OpenImageIO/imagebuf.h>

#include <memory>
#include <string>
#include <utility>
#include <vector>

namespace vmlight {

/// Size, channels and metadata of the lightmap of these inputs. `model` is the one that choose_model() found.
OIIO::ImageSpec describe_lightmap(const OIIO::ImageSpec& vismap, const OIIO::ImageSpec& cfem,
                                  const LightmapParams& params, const std::string& model);

/// Bad values that shading met.
struct ShadeFaults
{
    BadValues vismap, visibility, packed, albedo, result;
    std::string error;

    bool any() const
    {
        return vismap.any() || visibility.any() || packed.any() || albedo.any() || result.any() || !error.empty();
    }
    void merge(const ShadeFaults& other);
};

class LightmapShader
{
public:
    LightmapShader() = default;
    LightmapShader(const LightmapShader&) = delete;
    LightmapShader& operator=(const LightmapShader&) = delete;

    /// Prepare the light for one model and rotation.
    ///
    /// @param light    a CFEM, or at least those images of a stack that `model` reads; not needed afterwards
    /// @returns false, with the reason in `error`, if make_lightmap() would refuse them.
    bool prepare(OIIO::cspan<OIIO::ImageBuf> light, const LightmapParams& params, const ShadingModel& model,
                 std::string& error);

    /// Add the light of `suns`, of the pixels of the visibility map, to that of the model. Before prepare(), which
    /// refuses light whose suns were split off without them.
    void use_suns(std::shared_ptr<const SunLight> suns) { m_suns = std::move(suns); }

    /// Add `bounce`, of the pixels of the visibility map, to that.
    void use_bounce(std::shared_ptr<const BounceLight> bounce) { m_bounce = std::move(bounce); }

    /// Multiply by `albedo`, opened for the pixels of the visibility map. With `skip_one` it is looked at first: an
    /// albedo of 1, which changes nothing, is let go.
    void use_albedo(std::shared_ptr<const AlbedoReader> albedo, bool skip_one);

    /// Shade the pixels of `roi`. Any thread, with a `scratch` of its own.
    ///
    /// @param vismap   the floats of the model's channels, texel by texel
    /// @param rgb      set to three floats per texel
    /// @param faults   bad values are added
    void shade(OIIO::ROI roi, TexelLayout layout, const float* vismap, float* rgb, std::vector<float>& scratch,
               ShadeFaults& faults) const;

    /// The error message for `faults`. The names may be "".
    std::string fault_text(const ShadeFaults& faults, const std::string& vismap_name,
                           const std::string& albedo_name = "") const;

private:
    ShadingModel m_model;
    std::unique_ptr<ModelShader> m_shader;
    bool m_looks_up = true; // rather than that the light has one colour
    double m_gain = 1;
    std::shared_ptr<const SunLight> m_suns;
    std::shared_ptr<const BounceLight> m_bounce;
    std::shared_ptr<const AlbedoReader> m_albedo;
};

} // namespace vmlight
