// SPDX-License-Identifier: Apache-2.0
/// Bakes parts of a map, each an image of its own (map_part.h): joined, they are bit for bit the map of make_vismap(),
/// whatever the number of parts and whoever bakes which.
#pragma once

#include <vmlight/vismap/make_map.h>

#include <OpenImageIO/imagebuf.h>

#include <functional>
#include <string>
#include <vector>

namespace vmlight {

struct PartsJob
{
    MapJob map; ///< without a time budget, which depends on the machine
    int count = 1; ///< parts of the map
    std::vector<int> parts; ///< those to bake, from 1 on
    /// Adds metadata to the description of the map. May be empty.
    std::function<void(OIIO::ImageSpec& map)> tag;
    /// Whether a part need not be baked, by what it would be. May be empty.
    std::function<bool(int part, const OIIO::ImageSpec& spec)> is_made;
    /// Receives each part that was baked. Returns false, with the reason in `error`, to stop.
    std::function<bool(int part, const OIIO::ImageBuf& image, std::string& error)> write;
};

/// Bake parts one after the other. With reconstruction, the surroundings of a part's tiles are baked too.
///
/// @param report   set to the covered and overlapping texels of the whole map, and to the rays and times of the baked
///                 parts; dark texels are counted where parts are joined
/// @returns false, with the reason in `error`, as make_vismap(); parts that were written stay
bool bake_parts(const PartsJob& job, VismapReport& report, std::string& error);

} // namespace vmlight
