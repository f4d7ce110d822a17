// SPDX-License-Identifier: Apache-2.0
/// Differences between OpenImageIO 2.4 and 3.1, and its error texts. Not installed.
#pragma once

// First: texture.h declares vectors of its own where Imath's are not declared yet, which then clash.
#include <Imath/ImathVec.h>

#include <OpenImageIO/imagebufalgo.h>
#include <OpenImageIO/imageio.h>
#include <OpenImageIO/strutil.h>
#include <OpenImageIO/texture.h>

#include <algorithm>
#include <memory>
#include <string>
#include <vector>

namespace vmlight::oiio {

/// An error text of OIIO's on one line. OIIO 3 reports some errors in several lines, and some twice.
inline std::string one_line(const std::string& error)
{
    std::vector<std::string> lines;
    for (const std::string& line : OIIO::Strutil::splits(error, "\n"))
        if (!line.empty() && std::find(lines.begin(), lines.end(), line) == lines.end())
            lines.push_back(line);
    return OIIO::Strutil::join(lines, "; ");
}

/// The pending error of an ImageBuf, ImageInput, ImageOutput, TextureSystem or ColorConfig, on one line.
template <class Object> std::string error_line(Object& object)
{
    return one_line(object.geterror());
}

/// OIIO's own pending error, on one line.
inline std::string error_line()
{
    return one_line(OIIO::geterror());
}

/// OIIO's `reason` for `path`, prefixed with the path in quotes, which OIIO may have named already.
inline std::string with_path(const std::string& path, std::string reason)
{
    using OIIO::Strutil::replace, OIIO::Strutil::starts_with;
    const std::string quoted = "\"" + path + "\"", prefix = "Invalid image file " + quoted + ": ";
    if (starts_with(reason, prefix))
        reason.erase(0, prefix.size());
    if (starts_with(reason, quoted + " "))
        reason.erase(0, quoted.size() + 1);
    reason = replace(reason, "image file " + quoted, "image file", true);
    reason = replace(reason, "reader for " + quoted, "reader for it", true);
    reason = replace(reason, " (" + path + ")", "", true); // OpenEXR 3.4
    return quoted + ": " + reason;
}

/// Whether pixels that `file` says to have `read` are those of the file: its TIFF reader says so of a file that was cut
/// short, and leaves black and an error.
inline bool has_read(const OIIO::ImageInput& file, bool read)
{
    return read && !file.has_error();
}

/// OIIO's `reason` why the pixels of a file whose header it has read cannot be read: of decoders, which do not say that
/// most such files were copied in part.
inline std::string pixels_error(const std::string& reason)
{
    return "cannot read its pixels; the file may be damaged or incomplete (" + reason + ")";
}

/// Resize with a filter of OIIO's that is as wide as it is by default; a triangle's width is one pixel of the smaller
/// image.
inline bool resize(OIIO::ImageBuf& dst, const OIIO::ImageBuf& src, OIIO::ROI roi, int nthreads,
                   const char* filter = "triangle")
{
#if OIIO_VERSION >= 30000
    return OIIO::ImageBufAlgo::resize(dst, src, { { "filtername", filter } }, roi, nthreads);
#else
    return OIIO::ImageBufAlgo::resize(dst, src, filter, 0.0f, roi, nthreads);
#endif
}

/// A texture system of its own: others may have other limits.
inline std::shared_ptr<OIIO::TextureSystem> private_texture_system()
{
#if OIIO_VERSION >= 30000
    return OIIO::TextureSystem::create(false);
#else
    return { OIIO::TextureSystem::create(false),
             [](OIIO::TextureSystem* system) { OIIO::TextureSystem::destroy(system); } };
#endif
}

} // namespace vmlight::oiio
