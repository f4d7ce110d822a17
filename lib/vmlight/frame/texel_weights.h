// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vmlight/mesh/mesh.h>

#include <OpenImageIO/imagebuf.h>

#include <vector>

namespace vmlight {

/// How much the texels of a map of one UDIM tile count in a TexturePyramid: 1 where a triangle covers them; almost
/// nothing in the margin, which so counts only where nothing else is near; 0 outside.
///
/// @param vismap   float, in memory: its size is the map's, and where V and B are 0, nothing is known
std::vector<float> texel_weights(const Mesh& mesh, const OIIO::ImageBuf& vismap, int udim, int nthreads);

} // namespace vmlight
