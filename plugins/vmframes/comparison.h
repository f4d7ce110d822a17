// SPDX-License-Identifier: Apache-2.0
/// Pictures of several models: side by side, or one over the other.
#pragma once

#include <OpenImageIO/imagebuf.h>

#include <string>
#include <vector>

namespace vmlight::frames {

/// The root mean square of the differences of R, G, B between two frames, over the mean of `reference`; of pixels that
/// an object covers, by the channel `coverage`, which is the last. 0 if nothing is covered.
double relative_rms(const OIIO::ImageBuf& frame, const OIIO::ImageBuf& reference);

/// The frames in a row, from left to right.
OIIO::ImageBuf side_by_side(const std::vector<OIIO::ImageBuf>& frames);

/// The first frame to the left of a slanting line, the second to its right; the line is two pixels of white.
OIIO::ImageBuf wipe(const OIIO::ImageBuf& left, const OIIO::ImageBuf& right);

/// All frames in one picture of about three to two, each scaled down so that the picture is at most `width` wide.
OIIO::ImageBuf contact_sheet(const std::vector<OIIO::ImageBuf>& frames, int width);

} // namespace vmlight::frames
