// SPDX-License-Identifier: Apache-2.0
/// What is under the mouse.
#pragma once

#include "../scene/assets.h"

#include <cstddef>
#include <cstdint>
#include <string>

namespace vmlight::view {

struct CursorTexel
{
    bool is_on_mesh = false, is_on_strand = false, has_texel = false;
    size_t figure = 0; ///< 0: what was opened; from 1 on what is beside it
    uint32_t triangle = 0; ///< of a mesh
    int64_t strand = 0; ///< of strands
    Imath::V2d uv { 0 };
    int x = 0, y = 0; ///< of the map, from its upper left corner
};

/// The texel of a mesh or of strands at pixel (x, y), from the upper left corner, of a picture of `width` x `height`
/// pixels. `map` may be nullptr: there is no texel then.
CursorTexel texel_under(const MeshAsset& mesh, const MapAsset* map, const Camera& camera, double x, double y, int width,
                        int height);

/// V, B and other numbers of a texel, one a line.
std::string describe_texel(const MapAsset& map, int x, int y);

} // namespace vmlight::view
