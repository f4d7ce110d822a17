// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vmlight/stage/pixel_source.h>

#include <OpenImageIO/imagebuf.h>

#include <string>

namespace vmlight {

/// Open an image file as a source. Reads the header now, and pixels on demand in blocks: its tiles, or 64 scanlines.
/// The process caches up to 256 MiB of blocks. Not through an ImageCache: OIIO's shared one must not be called while it
/// calls a reader, and every ImageCache returns an unreadable tile as black from the second time on. Reads the first
/// image of a file with several, or number `first`; of a CFEM stack, read_all() and make() read the others too.
PixelSourcePointer open_stored_image(const std::string& path, std::string& error, int first = 0);

/// Read all pixels of `source` as float; `dst` has no name. Runs on the calling thread alone and never waits for OIIO's
/// thread pool, as callers that hold a lock need; PixelSource::make() is for all others.
bool read_all(OIIO::ImageBuf& dst, PixelSource& source, std::string& error, int subimage = 0);

} // namespace vmlight
