// SPDX-License-Identifier: Apache-2.0
/// Shading by the region: what make_lightmap() does for a whole map, a reader does for the tiles that are asked for.
/// Neither the order of regions nor their shape changes a bit.
#pragma once

#include <vmlight/base/faults.h>
#include <vmlight/lightmap/input.h>
#include <vmlight/lightmap/lightmap.h>
#include <vmlight/lightmap/model.h>
#include <vmlight/lightmap/shade_kernel.h>

#include <OpenImageIO/imagebuf.h>

#include <memory>
#include <string>
#include <utility>
#include <vector>

namespace vmlight {

/// The lightmap of these inputs: size, channels and metadata. `model` is the one that is used.
OIIO::ImageSpec describe_lightmap(const OIIO::ImageSpec& vismap, const OIIO::ImageSpec& cfem,
                                  const LightmapParams& params, const std::string& model);

/// What shading found wrong.
struct ShadeFaults
{
    Faults vismap, visibility, packed, albedo, result;
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

    /// `light`, one CFEM, or of the images of a stack at least those that `model` reads, is not needed any more
    /// afterwards. False, with the reason in `error`, as make_lightmap() does.
    bool prepare(OIIO::cspan<OIIO::ImageBuf> light, const LightmapParams& params, const ShadingModel& model,
                 std::string& error);

    /// Multiply by `albedo`, opened for the pixels of the visibility map.
    void use_albedo(std::shared_ptr<const AlbedoReader> albedo) { m_albedo = std::move(albedo); }

    /// Shade the pixels of `roi`. Any thread, with a `scratch` of its own.
    ///
    /// @param vismap   the numbers of the model's channels, texel by texel
    /// @param rgb      three floats a texel
    /// @param faults   what is wrong is added
    void shade(OIIO::ROI roi, VismapOrder order, const float* vismap, float* rgb, std::vector<float>& scratch,
               ShadeFaults& faults) const;

    /// What to tell of `faults`. The names may be "".
    std::string fault_text(const ShadeFaults& faults, const std::string& vismap_name,
                           const std::string& albedo_name = "") const;

private:
    bool prepare_one(OIIO::cspan<OIIO::ImageBuf> light, std::string& error);
    bool prepare_stack(OIIO::cspan<OIIO::ImageBuf> light, std::string& error);
    bool prepare_radiance(OIIO::cspan<OIIO::ImageBuf> light, const Rotation& rotation, std::string& error);

    ShadeTexels m_kernel = nullptr;
    ShadingModel m_model;
    ShadeSetup m_setup {};
    CfemLookup m_lookup;
    LobeLookup m_lobes;
    HarmonicLight m_harmonics;
    CellLight m_cells;
    std::shared_ptr<const AlbedoReader> m_albedo;
};

} // namespace vmlight
