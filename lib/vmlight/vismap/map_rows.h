// SPDX-License-Identifier: Apache-2.0
/// Maps that pass from the top down, without the whole of them in memory.
#pragma once

#include <vmlight/uv/margin.h>
#include <vmlight/vismap/reconstruct.h>

#include <OpenImageIO/imageio.h>

#include <functional>
#include <string>
#include <vector>

namespace vmlight {

/// A row of tiles. Rows of texels without padding.
struct TileRow
{
    std::vector<float> texels;
    Coverage covered; ///< of the tiles of which a texel was baked
    TexelContexts contexts; ///< empty if it needs no reconstruction
};

/// Receives a map from the top down. Returning false, with the reason in `error`, stops whoever makes it.
struct MapRows
{
    /// Size, channels and metadata, before the first row; may add metadata.
    std::function<bool(OIIO::ImageSpec& spec, std::string& error)> begin;
    /// Rows of texels from `ybegin` to `yend` - 1, whole rows of tiles, all channels, with their margin.
    std::function<bool(int ybegin, int yend, const float* texels, std::string& error)> take;
};

} // namespace vmlight
