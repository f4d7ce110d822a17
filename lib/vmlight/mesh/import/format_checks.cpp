// SPDX-License-Identifier: Apache-2.0
#include <vmlight/mesh/import/format_checks.h>

#include <OpenImageIO/strutil.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace vmlight {

using Imath::V3d;

OIIO::string_view first_text(const FileHead& head)
{
    OIIO::string_view text = head.bytes;
    OIIO::Strutil::parse_prefix(text, "\xef\xbb\xbf");
    OIIO::Strutil::skip_whitespace(text);
    return text;
}

bool is_far_from_origin(const std::vector<V3d>& positions)
{
    constexpr double infinity = std::numeric_limits<double>::infinity();
    V3d low(infinity), high(-infinity);
    bool finite = true;
    for (const V3d& p : positions)
        for (int axis = 0; axis < 3; ++axis) {
            finite &= std::isfinite(p[axis]);
            low[axis] = std::min(low[axis], p[axis]);
            high[axis] = std::max(high[axis], p[axis]);
        }
    if (!finite || positions.empty())
        return false;
    double side = 0, reach = 0;
    for (int axis = 0; axis < 3; ++axis) {
        side = std::max(side, high[axis] - low[axis]);
        reach = std::max({ reach, std::abs(low[axis]), std::abs(high[axis]) });
    }
    return side > 0 && reach > kFarFromOrigin * side;
}

} // namespace vmlight
