// SPDX-License-Identifier: Apache-2.0
/// A visibility map on the graphics card.
#pragma once

#include "../gl/objects.h"

#include <OpenImageIO/imagebuf.h>

#include <string>
#include <vector>

namespace vmlight::view {

struct MapTextures
{
    /// Layer 0: V and B; 1: the normal, of strands the tangent, or 0, and the coverage; from 2 on the harmonics that
    /// the model `sh` reads.
    Texture layers;
    int width = 0, height = 0;
    /// Harmonics of a texel, V and B among them; 4 without any others.
    int harmonics = 4;
    bool is_of_strands = false;

    /// Load a map, float and in memory.
    ///
    /// @param coverage one for each texel: the weight of its light in the mip levels
    /// @returns false, with the reason in `error`, if it is not a visibility map or larger than a texture can be.
    bool load(const OIIO::ImageBuf& vismap, const std::vector<float>& coverage, std::string& error);
};

/// Why an image cannot be a texture here, or "".
std::string texture_size_fault(const char* what, int width, int height);

} // namespace vmlight::view
