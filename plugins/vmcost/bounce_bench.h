// SPDX-License-Identifier: Apache-2.0
/// One bounce on a map, for measurements: every surface but the ground sends back the same share of the light.
#pragma once

#include <vmlight/base/progress.h>
#include <vmlight/stage/bounce_shading.h>
#include <vmlight/trace/bake_scene.h>

#include <OpenImageIO/imagebuf.h>

#include <memory>
#include <string>
#include <vector>

namespace vmlight::cost {

class BounceBench
{
public:
    /// @param scene    of the map, with all its occluders
    /// @param map      baked without a normal map; must outlive this
    BounceBench(BakeScenePointer scene, int udim, const OIIO::ImageBuf& map, int threads, const Progress& progress);

    /// Set `dst` to the light of `model` and the bounce. The first call traces from where texels get it.
    ///
    /// @param images   the filtered environment
    /// @returns false, with the reason in `error`, if it cannot be traced or the work was stopped
    bool light(OIIO::ImageBuf& dst, const std::vector<OIIO::ImageBuf>& images, const std::string& model,
               std::string& error);

    /// Whether some texel gets light from a surface.
    bool has_bounce() const;
    /// BounceParams::bounce_albedo.
    double albedo() const { return m_params.bounce_albedo; }

private:
    const OIIO::ImageBuf& m_map;
    MakeOptions m_options;
    const Progress m_progress;
    BounceParams m_params;
    std::shared_ptr<BounceShading> m_shading;
    OIIO::ImageBuf m_colors;
    BounceLight m_bounce;
};

} // namespace vmlight::cost
