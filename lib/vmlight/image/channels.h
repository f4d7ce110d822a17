// SPDX-License-Identifier: Apache-2.0
/// The image contract of the stages: channel names and the metadata that says what an image is.
/// Channels are found by name and never by index: EXR sorts them when it writes.
#pragma once

#include <vmlight/base/export.h>

#include <OpenImageIO/imageio.h>

#include <array>
#include <string>
#include <vector>

namespace vmlight {

/// `vmlight:stage` of a visibility map, a cosine-filtered environment map and a shaded texture.
constexpr const char* kVismapStage = "vismap";
constexpr const char* kCfemStage = "cfem";
constexpr const char* kLightmapStage = "lightmap";

/// Channels of a visibility map, in the order it is made: `visibility`, `direction.x`, `direction.y`, `direction.z`.
constexpr std::array<const char*, 4> kVismapChannels { "visibility", "direction.x", "direction.y", "direction.z" };
/// Optional channels of a visibility map: the shading normal n, in object space, of unit length where a triangle covers
/// the texel. What the model `ao` needs.
constexpr std::array<const char*, 3> kNormalChannels { "normal.x", "normal.y", "normal.z" };
/// Optional channel of a visibility map: the standard error of `visibility`.
constexpr const char* kErrorChannel = "error";
/// Optional channel of a visibility map: 1 where a triangle covers the texel, 0 in the margin and outside.
constexpr const char* kCoverageChannel = "coverage";

/// Optional channels of a visibility map that a basis adds (VismapParams::basis): `<basis>.<first>` up to
/// `<basis>.<end - 1>`.
VMLIGHT_API std::vector<std::string> numbered_channels(const std::string& basis, int first, int end);

/// Find the four channels of a visibility map.
///
/// @param index    set to the channels' places in the order of kVismapChannels
/// @param error    set to what is missing and what was found, if any is missing or `vmlight:stage` says another stage
/// @returns false if the image is not a visibility map, or none any more: its `colorInteropID` is a colour space's, or
///          the program that wrote it (`Software`) says that it converted colour. OIIO 2.4 converts data as readily as
///          colour, and nothing in the pixels would tell. An image without `vmlight:stage` passes on its channels
///          alone.
VMLIGHT_API bool find_vismap_channels(const OIIO::ImageSpec& spec, std::array<int, 4>& index, std::string& error);

/// Find the colour channels R, G, B. One named Y, or the only one, unless it is A or Z, serves as all three.
///
/// @param index    set to the channels' places
/// @param error    set to what is missing and what was found, if there is no colour or `vmlight:stage` is `vismap`
/// @returns false if the image has no colour to be used as light.
VMLIGHT_API bool find_color_channels(const OIIO::ImageSpec& spec, std::array<int, 3>& index, std::string& error);

/// False, with the reason in `error`, if the image's display window, which stands for the whole sphere or texture
/// however few pixels are stored of it, has no pixels, a side of more than 65536, or more than 2^27 pixels of which not
/// one in 256 is stored: a few pixels in a window of billions would be filtered for hours. Or if the file says that its
/// pixels are stored flipped or turned.
VMLIGHT_API bool check_window(const OIIO::ImageSpec& spec, std::string& error);

} // namespace vmlight
