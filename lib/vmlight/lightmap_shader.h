// SPDX-License-Identifier: Apache-2.0
/// Shading by the region: what make_lightmap() does for a whole map, a reader does for the tiles that are asked for.
/// Neither the order of regions nor their shape changes a bit.
#pragma once

#include <vmlight/export.h>
#include <vmlight/faults.h>
#include <vmlight/lightmap.h>
#include <vmlight/lightmap_input.h>
#include <vmlight/shade_kernel.h>

#include <OpenImageIO/imagebuf.h>

#include <array>
#include <memory>
#include <string>
#include <utility>
#include <vector>

namespace vmlight {

/// The lightmap of these inputs: size, channels and metadata. `has_stack`: whether `cfem` is the first level of one.
OIIO::ImageSpec describe_lightmap(const OIIO::ImageSpec& vismap, const OIIO::ImageSpec& cfem,
                                  const LightmapParams& params, bool has_stack);

/// What shading found wrong.
struct ShadeFaults
{
    Faults vismap, albedo, result;
    std::string error;

    bool any() const { return vismap.any() || albedo.any() || result.any() || !error.empty(); }
    void merge(const ShadeFaults& other);
};

class LightmapShader
{
public:
    LightmapShader() = default;
    LightmapShader(const LightmapShader&) = delete;
    LightmapShader& operator=(const LightmapShader&) = delete;

    /// `cfem`, one or the levels of a stack, is not needed any more afterwards. False, with the reason in `error`, as
    /// make_lightmap() does.
    VMLIGHT_API bool prepare(OIIO::cspan<OIIO::ImageBuf> cfem, const LightmapParams& params, std::string& error);

    /// Multiply by `albedo`, opened for the pixels of the visibility map.
    void use_albedo(std::shared_ptr<const AlbedoReader> albedo) { m_albedo = std::move(albedo); }

    /// Shade the pixels of `roi`. Any thread, with a `scratch` of its own.
    ///
    /// @param vismap   four floats a texel
    /// @param rgb      three floats a texel
    /// @param faults   what is wrong is added
    VMLIGHT_API void shade(OIIO::ROI roi, VismapOrder order, const float* vismap, float* rgb,
                           std::vector<float>& scratch, ShadeFaults& faults) const;

    /// What to tell of `faults`. The names may be "".
    VMLIGHT_API std::string fault_text(const ShadeFaults& faults, const std::string& vismap_name,
                                       const std::string& albedo_name = "") const;

private:
    ShadeTexels m_kernel = nullptr;
    std::array<const char*, 4> m_vismap_channels {};
    ShadeSetup m_setup {};
    CfemLookup m_lookup;
    LobeLookup m_lobes;
    std::shared_ptr<const AlbedoReader> m_albedo;
};

} // namespace vmlight
