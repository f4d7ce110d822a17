// SPDX-License-Identifier: Apache-2.0
/// Pictures for screens: PNG, JPEG, WebP, and animated GIF.
#pragma once

#include <OpenImageIO/imagebuf.h>

#include <string>
#include <vector>

namespace vmlight {

/// Whether the name is that of a picture for screens, by its extension, in upper or lower case.
bool is_picture_name(const std::string& path);
/// Whether it is an animated GIF's.
bool is_animation_name(const std::string& path);

/// Write 8 bit pictures atomically: one, or the frames of an animation of `fps` frames a second.
///
/// @param pictures R, G, B in [0, 1] as a display takes them, float or 8 bit, and A, which they are not multiplied by:
/// JPEG gets it
///                 black where it is transparent
/// @returns false, with the reason in `error`, on failure; `path` is then unchanged
bool write_picture(const OIIO::ImageBuf& picture, const std::string& path, std::string& error);
bool write_animation(const std::vector<OIIO::ImageBuf>& pictures, const std::string& path, double fps,
                     std::string& error);

} // namespace vmlight
