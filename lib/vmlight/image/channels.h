// SPDX-License-Identifier: Apache-2.0
/// The image contract of the stages: channel names, and the metadata that identifies a stage's image. Channels are
/// looked up by name, never by index: EXR files store them sorted.
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

/// Channels of a visibility map, in the order in which they are made: `visibility`, `direction.x`, `direction.y`,
/// `direction.z`.
constexpr std::array<const char*, 4> kVismapChannels { "visibility", "direction.x", "direction.y", "direction.z" };
/// Optional channels of a visibility map: the shading normal n in object space, of unit length where a triangle covers
/// the texel. The model `ao` needs it.
constexpr std::array<const char*, 3> kNormalChannels { "normal.x", "normal.y", "normal.z" };
/// Optional channel of a visibility map: the standard error of `visibility`.
constexpr const char* kErrorChannel = "error";
/// Optional channel of a visibility map: 1 where a triangle covers the texel, 0 in the margin and outside.
constexpr const char* kCoverageChannel = "coverage";

/// Channels of a visibility map of strands: the tangent t in object space, of unit length, from root to tip; 0 where
/// there is no strand.
constexpr std::array<const char*, 3> kTangentChannels { "tangent.x", "tangent.y", "tangent.z" };

/// `vmlight:kernel`: how light is weighted by its direction w. Images without it have the first.
constexpr const char* kCosineKernel = "cosine"; ///< (1/pi) max(0, n.w), of a diffuse surface with the normal n
constexpr const char* kStrandKernel = "strand"; ///< (1/pi^2) sin(t, w), of a strand with the tangent t
/// The kernel of a visibility map or a filtered environment.
VMLIGHT_API std::string kernel_of(const OIIO::ImageSpec& spec);

/// Optional channels of a visibility map that a basis adds (VismapParams::basis): `<basis>.<first>` up to
/// `<basis>.<end - 1>`.
VMLIGHT_API std::vector<std::string> numbered_channels(const std::string& basis, int first, int end);

/// Find the four channels of a visibility map.
///
/// @param index    set to the channel indices, in the order of kVismapChannels
/// @param error    set to what is missing and what was found, on failure
/// @returns false if a channel is missing, `vmlight:stage` names another stage, orientation_fault() gives one, or a
///          colour conversion may have damaged the map: its `colorInteropID` is a colour space, or its `Software`
///          attribute shows a colour conversion (OIIO 2.4 converts data channels too, and the pixels do not show it).
///          An image without `vmlight:stage` needs only the channels.
VMLIGHT_API bool find_vismap_channels(const OIIO::ImageSpec& spec, std::array<int, 4>& index, std::string& error);

/// Find the colour channels R, G, B. A channel Y is used for all three, unless X or other channels say that it is no
/// grey; alpha, depth and layers do not. Channels of any other name are not light.
///
/// @param index    set to the channel indices
/// @param error    set to what is missing, what was found and what to do, on failure
/// @returns false if the image has no colour channels or is a visibility map.
VMLIGHT_API bool find_color_channels(const OIIO::ImageSpec& spec, std::array<int, 3>& index, std::string& error);

/// Why pixels are not where they seem to be, or "": the Orientation is not 1.
VMLIGHT_API std::string orientation_fault(const OIIO::ImageSpec& spec);

/// The layers that have colour: `NAME` for channels `NAME.R`, `NAME.G`, `NAME.B`, or `NAME.Y`.
std::vector<std::string> color_layers(const OIIO::ImageSpec& spec);

/// Find the colour channels of a layer; false if it has none.
bool find_layer_channels(const OIIO::ImageSpec& spec, const std::string& layer, std::array<int, 3>& index);

/// Check that the display window, which is the whole sphere or texture whatever part of it is stored, can be processed.
/// Returns false, with the reason in `error`, if it is empty, a side is longer than 65536, fewer than 1 in 256 of more
/// than 2^27 pixels are stored (filtering them would take hours), or the Orientation is not 1.
VMLIGHT_API bool check_window(const OIIO::ImageSpec& spec, std::string& error);

} // namespace vmlight
