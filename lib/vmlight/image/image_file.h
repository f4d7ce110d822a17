// SPDX-License-Identifier: Apache-2.0
/// Images in files: read whole, written atomically.
#pragma once

#include <vmlight/base/progress.h>

#include <OpenImageIO/imagebuf.h>

#include <string>

namespace vmlight {

/// Whether there can be an image of this name: it is a file's, or has a '?', and another plugin may make it without
/// one. A pipe would hold its reader up.
bool may_be_image(const std::string& name);

/// Why what a header says of its image cannot be meant, or "": no side of its pixels, or of the display window around
/// them, is longer than 2^20. What goes through a damaged one pixel by pixel would not come to an end.
std::string header_fault(const OIIO::ImageSpec& spec);

/// Read all of an image that OIIO opens into memory, as float. False, with the reason and the path in `error`: before
/// it is read if there is no memory for it.
bool read_image(OIIO::ImageBuf& dst, const std::string& path, std::string& error, int subimage = 0);

/// Why `path` cannot be the name of an output, wherever it is, or "": it must end in .exr (other formats lose channel
/// names, range or the mark that says data from colour).
std::string output_name_fault(const std::string& path);

/// Why no output can be written to `path` as things are, or "": besides its name, it must lie in a folder that exists
/// and can be written, and not be a folder, a device or a pipe. Of a link all that is asked of what it leads to.
std::string output_fault(const std::string& path);

/// Write `image` as a ZIP-compressed EXR, of `format` "float" or "half": into a file of no name, flushed to the disk,
/// then given its name. A link stays, and the file that it leads to is replaced or made. On failure, and when
/// `progress` returns false, `path` is as it was and nothing is left over. The bytes depend on the pixels and metadata
/// alone: no date, host or command line. False, with the reason in `error`; a value beyond the range of half is
/// refused, never written as infinity.
bool write_image(const OIIO::ImageBuf& image, const std::string& path, const std::string& format,
                 const Progress& progress, std::string& error);
/// The same for several images in one file, the first of them what opens by default. Each has its name in
/// `oiio:subimagename`.
bool write_images(OIIO::cspan<OIIO::ImageBuf> images, const std::string& path, const std::string& format,
                  const Progress& progress, std::string& error);

} // namespace vmlight
