// SPDX-License-Identifier: Apache-2.0
/// Films by ffmpeg, where that is installed.
#pragma once

#include <OpenImageIO/imagebuf.h>

#include <string>
#include <vector>

namespace vmlight::frames {

/// Whether the name is that of a film: .mp4, .mov or .webm.
bool is_film_name(const std::string& path);

/// Why no film can be made, or "": ffmpeg is not in $PATH.
std::string film_fault();

/// Encode pictures, R, G, B in [0, 1] and A, which is laid over black, as H.264 (.mp4, .mov) or VP9 (.webm),
/// atomically. Sides are cut to even numbers. False, with the reason in `error` (ffmpeg's last words), on failure;
/// `path` is then unchanged.
bool write_film(const std::vector<OIIO::ImageBuf>& pictures, const std::string& path, double fps, std::string& error);

} // namespace vmlight::frames
