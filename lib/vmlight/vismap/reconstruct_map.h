// SPDX-License-Identifier: Apache-2.0
/// Reconstruction of tiles and whole maps, over the seams between their islands.
#pragma once

#include <vmlight/base/progress.h>
#include <vmlight/vismap/reconstruct.h>

#include <cstddef>
#include <cstdint>
#include <functional>

namespace vmlight {

class VismapBaker;

/// A texel as it was baked; two nullptr where no triangle covers it.
struct BakedTexel
{
    const float* texel = nullptr;
    const TexelContext* context = nullptr;
};

/// Any texel of the map. What it points to must stay where it is.
using FindTexel = std::function<BakedTexel(int x, int y)>;

/// Reconstruct a tile, from it and the texels that `find` has around it and beyond its seams.
///
/// @param tile     its number, row by row
/// @param raw, texels, pitch, contexts  as for Reconstruction::apply()
/// @returns how many texels have V below 0.01
int64_t reconstruct_tile(Reconstruction& reconstruction, const VismapBaker& baker, int tile, const FindTexel& find,
                         const float* raw, float* texels, size_t pitch, const TexelContexts& contexts);

/// Reconstruct a whole map. False if `progress` stopped it.
bool reconstruct_map(const VismapBaker& baker, float* pixels, const TexelContexts& contexts, int64_t& dark,
                     int nthreads, const Progress& progress);

} // namespace vmlight
