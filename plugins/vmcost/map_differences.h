// SPDX-License-Identifier: Apache-2.0
/// How far maps and their light differ over the texels that a mesh covers.
#pragma once

#include <OpenImageIO/imagebuf.h>

namespace vmlight::cost {

/// RMS of the difference of V of two visibility maps of one size, with the channel `coverage`.
double visibility_difference(const OIIO::ImageBuf& a, const OIIO::ImageBuf& b);

/// RMS of the difference of two lightmaps of `map`, relative to the mean of `truth`; 0 if that is black.
double light_difference(const OIIO::ImageBuf& other, const OIIO::ImageBuf& truth, const OIIO::ImageBuf& map);

} // namespace vmlight::cost
