// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vmlight/stage/pixel_source.h>

#include <string>

namespace vmlight {

/// Open the colour of one layer of the image file `path` as a source of R, G, B: of the part that is called `layer`, or
/// of the channels `layer.R`, `layer.G`, `layer.B` (or `layer.Y`) of any part. A part's name may lead the layer's, as
/// in Blender's `ViewLayer.Combined`. nullptr, with the reason in `error`, if there is none; it lists those that are
/// there.
PixelSourcePointer open_layer(const std::string& path, const std::string& layer, std::string& error);

/// Of an image without colour in its first part: "; choose a layer with FLAG: A, B", or "" if no other part has colour.
std::string layer_advice(const std::string& path, const char* flag);

} // namespace vmlight
