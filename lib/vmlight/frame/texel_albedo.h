// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vmlight/frame/frame_scene.h>

#include <OpenImageIO/imagebuf.h>

namespace vmlight {

/// What a surface sends back of the light on each texel of its visibility map: the albedo that bounced light needs.
///
/// @param vismap   float, in memory, with V and B
/// @param udim     the tile of the map
/// @param otherwise    the albedo where materials say no colour (look_up_albedo())
/// @returns R, G, B, float, of the size of `vismap`, in the space of the materials. A texture that has the map's size
///          and UVs keeps its texels. Texels that no triangle covers have the mean of their neighbours
OIIO::ImageBuf texel_albedo(const FrameSurface& surface, const OIIO::ImageBuf& vismap, int udim, float otherwise,
                            int nthreads);

} // namespace vmlight
