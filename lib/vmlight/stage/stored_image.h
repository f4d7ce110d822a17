// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vmlight/stage/pixel_source.h>

#include <OpenImageIO/imagebuf.h>

#include <string>

namespace vmlight {

/// An image file as a source: its header now, its pixels by its tiles or by 64 scanlines, of which the process keeps up
/// to 256 MiB. Not through an ImageCache: OIIO's shared one must not be asked while it asks a reader, and any gives out
/// a tile that could not be read as black from the second time on. Of a file with several images the first; of a stack
/// of CFEM read_all() reads the others too.
PixelSourcePointer open_stored_image(const std::string& path, std::string& error);

/// All pixels of `source` in memory, as float; `dst` has no name. On the calling thread; a file may be decoded by more,
/// `oiio_threads` (0 is OIIO's default): one alone never waits for OIIO's thread pool, as is needed under a lock.
bool read_all(OIIO::ImageBuf& dst, PixelSource& source, std::string& error, int subimage = 0, int oiio_threads = 1);

} // namespace vmlight
