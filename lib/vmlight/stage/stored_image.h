// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vmlight/stage/pixel_source.h>

#include <OpenImageIO/imagebuf.h>

#include <string>

namespace vmlight {

/// Open an image file as a source. Reads the header now, and pixels on demand in blocks: its tiles, or 64 scanlines. The
/// process caches up to 256 MiB of blocks. Not through an ImageCache: OIIO's shared one must not be called while it
/// calls a reader, and every ImageCache returns an unreadable tile as black from the second time on. Reads the first
/// image of a file with several; of a CFEM stack, read_all() and make() read the others too.
PixelSourcePointer open_stored_image(const std::string& path, std::string& error);

/// Read all pixels of `source` as float; `dst` has the name of the file, if it is one. Runs on the calling thread, except that `oiio_threads`
/// threads may decode a file (0: OIIO's default). With 1 it never waits for OIIO's thread pool, as callers that hold a
/// lock need.
bool read_all(OIIO::ImageBuf& dst, PixelSource& source, std::string& error, int subimage = 0, int oiio_threads = 1);

} // namespace vmlight
