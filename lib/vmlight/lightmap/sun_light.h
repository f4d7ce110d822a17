// SPDX-License-Identifier: Apache-2.0
/// The light of suns on the texels of a visibility map, which shading models leave to this.
#pragma once

#include <vmlight/cfem/suns.h>
#include <vmlight/lightmap/lightmap.h>

#include <OpenImageIO/imagebuf.h>

#include <vector>

namespace vmlight {

struct SunLight
{
    std::vector<Sun> suns;
    /// Pixels of the map.
    OIIO::ROI roi;
    /// For each texel of `roi` and each sun, T = mean over the disc of vis(w) max(0, n.w).
    std::vector<float> visibility;

    /// Add color x T x gain of all suns to `rgb`, the pixels of `part` of roi, rows without padding.
    void add(OIIO::ROI part, double gain, float* rgb) const;
};

/// Whether the images of the light and `suns`, which may be nullptr, are 0 everywhere. Reads up to the first pixel that
/// is not.
bool is_black(OIIO::cspan<OIIO::ImageBuf> cfem, const std::vector<Sun>* suns);

/// The other make_lightmap(), with suns: `cfem` is the environment's rest (SunSplit), and to what the model makes of it
/// the light of `suns` is added, before the albedo and the exposure.
///
/// @param suns     nullptr, or of the pixels of `vismap`
bool make_lightmap(OIIO::ImageBuf& dst, const OIIO::ImageBuf& vismap, OIIO::cspan<OIIO::ImageBuf> cfem,
                   const SunLight* suns, const LightmapParams& params, const OIIO::ImageBuf* albedo, int nthreads,
                   const Progress& progress);

} // namespace vmlight
