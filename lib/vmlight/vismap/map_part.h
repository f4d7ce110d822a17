// SPDX-License-Identifier: Apache-2.0
/// A part of a visibility map as an image: some of its tiles, cropped, and whatever it takes to fit them together. The
/// display window is the whole map. The margin is not filled yet.
///
/// `vmlight:stage` is kPartStage. Beside the map's own metadata there are `vmlight:part` ("3/16"), `vmlight:partTiles`
/// ("32-47", counted row by row; "" for none), `vmlight:partChannels` (of the map, in their order), `vmlight:partEmpty`
/// (names of the map's metadata that are empty) and `vmlight:partInputs` (a hash of those inputs that the map's
/// metadata do not identify). The channel `coverage` is always there.
#pragma once

#include <vmlight/base/part_number.h>
#include <vmlight/vismap/tile_shares.h>

#include <OpenImageIO/imageio.h>

#include <string>

namespace vmlight {

constexpr const char* kPartStage = "vismap part";

/// The place of tile number `tile` in an image of the size of `spec`'s display window.
OIIO::ROI tile_window(const OIIO::ImageSpec& spec, int tile);
/// The number of tiles of that image.
int tile_count(const OIIO::ImageSpec& spec);

/// Describe a part of a map.
/// @param whole    the map
/// @param inputs   for `vmlight:partInputs`
OIIO::ImageSpec describe_part(const OIIO::ImageSpec& whole, PartNumber part, TileRange tiles,
                              const std::string& inputs);

/// Which part of a map an image is, and which tiles it has. False, with the reason in `error`, if it is none, or if its
/// metadata do not fit its size and channels.
bool read_part(PartNumber& part, TileRange& tiles, const OIIO::ImageSpec& spec, std::string& error);

/// Why two parts are not of the same map, or "": the first difference of their metadata, "its seed is 1, not 0".
/// @param spec, expected   of parts that read_part() accepts
std::string part_fault(const OIIO::ImageSpec& spec, const OIIO::ImageSpec& expected);

/// The map that a part is of.
OIIO::ImageSpec whole_of_part(const OIIO::ImageSpec& part);

} // namespace vmlight
