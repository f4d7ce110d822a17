// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "statistics.h"

#include <OpenImageIO/imagebuf.h>

namespace vmlight::cost {

/// A lightmap at the size of the reference, as a renderer would show it: bilinearly.
OIIO::ImageBuf shown(const OIIO::ImageBuf& lightmap, const OIIO::ImageBuf& reference);

/// The error of a lightmap over the texels that a reference covers, R, G and B together.
///
/// @param lightmap R, G, B of the reference's size
/// @param reference as make_reference() makes it
Errors compare(const OIIO::ImageBuf& lightmap, const OIIO::ImageBuf& reference);

/// Texels that a reference covers.
int64_t covered_texels(const OIIO::ImageBuf& reference);

/// Batches of which some texel is lit. An error relative to the light has an interval from 2 on: see errors_of().
int lit_batches(const OIIO::ImageBuf& reference);

} // namespace vmlight::cost
