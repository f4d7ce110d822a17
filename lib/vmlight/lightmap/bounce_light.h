// SPDX-License-Identifier: Apache-2.0
/// The light that surfaces send to the texels of a visibility map, which shading models leave to this.
#pragma once

#include <vmlight/lightmap/lightmap.h>
#include <vmlight/lightmap/sun_light.h>

#include <OpenImageIO/imagebuf.h>

#include <vector>

namespace vmlight {

struct BounceLight
{
    /// Pixels of the map.
    OIIO::ROI roi;
    /// Three floats for each texel of `roi`, without exposure.
    std::vector<float> light;

    /// Add light x gain to `rgb`, the pixels of `part` of roi, rows without padding.
    void add(OIIO::ROI part, double gain, float* rgb) const;
};

/// The other make_lightmap(), with light besides the model's, before the albedo and the exposure.
///
/// @param suns     nullptr, or as for that with suns
/// @param bounce   nullptr, or of the pixels of `vismap`
bool make_lightmap(OIIO::ImageBuf& dst, const OIIO::ImageBuf& vismap, OIIO::cspan<OIIO::ImageBuf> cfem,
                   const SunLight* suns, const BounceLight* bounce, const LightmapParams& params,
                   const OIIO::ImageBuf* albedo, int nthreads, const Progress& progress);

} // namespace vmlight
