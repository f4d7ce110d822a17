// SPDX-License-Identifier: Apache-2.0
/// Image files: read completely, written atomically.
#pragma once

#include <vmlight/base/params.h>
#include <vmlight/base/progress.h>

#include <OpenImageIO/imagebuf.h>
#include <OpenImageIO/imageio.h>

#include <memory>
#include <string>

namespace vmlight {

/// Whether OIIO may be asked to open `name`: it is a regular file (a pipe would block), or no file but ends in a query
/// ("?KEY=VALUE&..."), so that a plugin may generate it.
bool may_be_image(const std::string& name);

/// Open an image file, or a name that a plugin generates, through OIIO, as every input is: colour comes as stored, not
/// multiplied by alpha. nullptr with the reason and the path in `error`. A header that claims more than its file can
/// hold and what OIIO misreads (image/file_claims.h) are refused first.
std::unique_ptr<OIIO::ImageInput> open_image(const std::string& name, std::string& error);

/// Whether all pixels of an image of a TIFF file can be read: false, with the reason and the path in `error`, if it was
/// cut short, of which ImageBuf and the texture system show what is left, and black (other formats fail). Reads it.
bool is_whole_tiff(const std::string& path, int subimage, std::string& error);

/// Why a header is implausible, or "": a side of the data or display window is longer than 2^20. Protects loops over
/// pixels from damaged headers.
std::string header_fault(const OIIO::ImageSpec& spec);

/// Read a whole image into memory as float. Returns false, with the reason and the path in `error`; if it does not fit
/// in memory, before reading.
bool read_image(OIIO::ImageBuf& dst, const std::string& path, std::string& error, int subimage = 0);

/// Why `path` is not a valid output name, or "": it must end in .exr (other formats lose channel names, range or the
/// data tag). For .hdr the text gives the command that converts light without turning negative channels bright.
std::string output_name_fault(const std::string& path);

/// Why `path` cannot be written now, or "": output_name_fault() or output_file_fault().
std::string output_fault(const std::string& path);

/// How an EXR stores its pixels.
struct FileParams
{
    std::string format = "float", compression = "zip";

    template <class Visit> void visit(Visit&& field)
    {
        field("format", format, Choices { { { "float", "32 bits per channel" }, { "half", "16 bits per channel" } } },
              "Pixel format of the output file, if an EXR");
        field("compression", compression,
              Choices { { { "zip", "lossless" }, { "none", "a larger file, written several times as fast" } } },
              "Compression of the output file, if an EXR");
    }
};

/// Write `image` atomically as an EXR. Symbolic links are followed. On failure, and if `progress` returns false,
/// returns false, with the reason in `error`: `path` is then unchanged and no temporary file is left. The bytes depend
/// on pixels, metadata and `file` only: no date, host or command line. Values beyond the range of half are refused, not
/// written as infinity.
bool write_image(const OIIO::ImageBuf& image, const std::string& path, const FileParams& file, const Progress& progress,
                 std::string& error);
/// The same for several images (EXR parts) in one file; the first opens by default. Their names are in
/// `oiio:subimagename`.
bool write_images(OIIO::cspan<OIIO::ImageBuf> images, const std::string& path, const FileParams& file,
                  const Progress& progress, std::string& error);

} // namespace vmlight
