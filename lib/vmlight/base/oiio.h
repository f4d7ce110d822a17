// SPDX-License-Identifier: Apache-2.0
/// Where OpenImageIO 2.4 and 3.1 differ. Not installed.
#pragma once

#include <OpenImageIO/imagebufalgo.h>
#include <OpenImageIO/strutil.h>

#include <algorithm>
#include <string>
#include <vector>

namespace vmlight::oiio {

/// Why the last call of an ImageBuf, ImageOutput or ColorConfig failed, on one line: OIIO 3 says some reasons twice, on
/// a line each.
template <class Object> std::string reason(Object& object)
{
    std::vector<std::string> lines;
    for (const std::string& line : OIIO::Strutil::splits(object.geterror(), "\n"))
        if (!line.empty() && std::find(lines.begin(), lines.end(), line) == lines.end())
            lines.push_back(line);
    return OIIO::Strutil::join(lines, "; ");
}

/// `reason`, which OIIO gives for `path`, led by the path in quotes: once, though OIIO may name it too.
inline std::string named_reason(const std::string& path, std::string reason)
{
    using namespace OIIO::Strutil;
    const std::string quoted = "\"" + path + "\"", prefix = "Invalid image file " + quoted + ": ";
    if (starts_with(reason, prefix))
        reason.erase(0, prefix.size());
    if (starts_with(reason, quoted + " "))
        reason.erase(0, quoted.size() + 1);
    reason = replace(reason, "image file " + quoted, "image file", true);
    reason = replace(reason, "reader for " + quoted, "reader for it", true);
    reason = replace(reason, " (" + path + ")", "", true); // OpenEXR 3.4's own words
    return quoted + ": " + reason;
}

/// Resize by a triangle filter, one pixel of the smaller image wide.
inline bool resize(OIIO::ImageBuf& dst, const OIIO::ImageBuf& src, OIIO::ROI roi, int nthreads)
{
#if OIIO_VERSION >= 30000
    return OIIO::ImageBufAlgo::resize(dst, src, { { "filtername", "triangle" } }, roi, nthreads);
#else
    return OIIO::ImageBufAlgo::resize(dst, src, "triangle", 0.0f, roi, nthreads);
#endif
}

} // namespace vmlight::oiio
