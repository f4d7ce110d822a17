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
