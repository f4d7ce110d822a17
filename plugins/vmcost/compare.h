// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "statistics.h"

#include <OpenImageIO/imagebuf.h>

namespace vmlight::cost {

/// The lightmap, resized to the reference bilinearly, as a renderer would look it up.
OIIO::ImageBuf resize_to_reference(const OIIO::ImageBuf& lightmap, const OIIO::ImageBuf& reference);

/// The error of a lightmap over the covered texels of a reference, over R, G and B.
///
/// @param lightmap R, G, B of the reference's size
/// @param reference as make_reference() makes it
/// @param visibility the weights of Errors::rmse_by_visibility: the first channel of an image of the reference's size
Errors compare(const OIIO::ImageBuf& lightmap, const OIIO::ImageBuf& reference, const OIIO::ImageBuf& visibility);

/// Number of covered texels of a reference.
int64_t covered_texels(const OIIO::ImageBuf& reference);

/// Number of batches with a lit texel. errors_of() needs at least 2 for a confidence interval.
int lit_batches(const OIIO::ImageBuf& reference);

} // namespace vmlight::cost
