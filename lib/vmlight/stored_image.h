// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vmlight/pixel_source.h>

#include <OpenImageIO/imagebuf.h>

#include <string>

namespace vmlight {

/// An image file as a source, all its images if it is a stack of CFEM, else the first: its header now, its pixels by
/// the region, through an ImageCache of its own. (OIIO's shared one must not be asked while it asks a reader.)
PixelSourcePointer open_stored_image(const std::string& path, std::string& error);

/// All pixels of `source` in memory, as float. On the calling thread, and without waiting for OIIO's thread pool.
bool read_all(OIIO::ImageBuf& dst, PixelSource& source, std::string& error, int subimage = 0);

} // namespace vmlight
