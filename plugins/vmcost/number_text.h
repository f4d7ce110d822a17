// SPDX-License-Identifier: Apache-2.0
/// Number formatting for the report.
#pragma once

#include <vmlight/base/format.h>

#include <OpenImageIO/strutil.h>

#include <cmath>
#include <string>

namespace vmlight::cost {

/// "12.3 %", with three significant digits.
inline std::string percent_text(double share)
{
    const double x = 100 * share, size = std::abs(x);
    return format("{:.{}f} %", x, size < 0.995 ? 2 : size < 99.95 ? 1 : 0);
}

/// "1.2 ms", "3.4 s", "12 min"
inline std::string seconds_text(double seconds)
{
    const double ms = 1000 * seconds;
    if (ms < 995)
        return format("{:.{}f} ms", ms, ms < 0.0995 ? 3 : ms < 0.995 ? 2 : ms < 9.95 ? 1 : 0);
    return seconds < 600 ? format("{:.{}f} s", seconds, seconds < 9.95 ? 1 : 0) : format("{:.0f} min", seconds / 60);
}

/// Escape text for HTML.
inline std::string escaped(std::string text)
{
    for (const auto& [plain, code] :
         { std::pair { "&", "&amp;" }, { "<", "&lt;" }, { ">", "&gt;" }, { "\"", "&quot;" } })
        text = OIIO::Strutil::replace(text, plain, code, true);
    return text;
}

} // namespace vmlight::cost
