// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vmlight/trace/moved_boxes.h>
#include <vmlight/vismap/baker.h>
#include <vmlight/vismap/ray_bits.h>
#include <vmlight/vismap/reconstruct.h>

#include <cstdint>
#include <vector>

namespace vmlight {

/// What a bake knows of another pose of the mesh, and keeps for the next. Changes no bit of what is baked.
struct BakeHints
{
    /// nullptr, or the texels of the tile to bake: the others are neither traced nor written, nor counted as dark or
    /// open.
    const TileBits* only = nullptr;
    /// nullptr, or the rays of the texels in another pose, with what has moved since; for triangles that `still` has.
    const RayBits* known = nullptr;
    const MovedBoxes* moved = nullptr;
    const std::vector<uint8_t>* still = nullptr;
    /// nullptr, or set to the rays of all texels.
    RayBits* record = nullptr;
    /// nullptr, or set to what reconstruction needs of all texels that are baked.
    TexelContexts* contexts = nullptr;
    /// nullptr, or set to Visibility::error of all texels that are baked, row by row.
    double* errors = nullptr;
};

/// Of a texel, whose ray origin is settled.
inline RayMemory memory_of(const BakeHints& hints, const SurfacePoint& point, uint32_t triangle, int x, int y)
{
    RayMemory memory;
    const uint8_t origin = point.is_near ? RayBits::near : RayBits::far;
    if (hints.known && (*hints.still)[triangle] && hints.known->at(x, y)[hints.known->packets()] == origin) {
        memory.known = hints.known->at(x, y);
        memory.moved = hints.moved;
    }
    if (hints.record) {
        memory.record = hints.record->at(x, y);
        memory.record[hints.record->packets()] = origin;
    }
    return memory;
}

} // namespace vmlight
