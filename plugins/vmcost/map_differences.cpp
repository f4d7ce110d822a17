// SPDX-License-Identifier: Apache-2.0
#include "map_differences.h"

#include <vmlight/math/difference.h>

namespace vmlight::cost {

double visibility_difference(const OIIO::ImageBuf& a, const OIIO::ImageBuf& b)
{
    const int channels = a.nchannels(), coverage = a.spec().channelindex("coverage");
    const auto *p = static_cast<const float*>(a.localpixels()), *q = static_cast<const float*>(b.localpixels());
    Difference off;
    for (size_t i = 0; i < size_t(a.spec().image_pixels()); ++i, p += channels, q += channels)
        if (p[coverage] != 0)
            off.add(double(p[0]), double(q[0]));
    return off.rms();
}

double light_difference(const OIIO::ImageBuf& other, const OIIO::ImageBuf& truth, const OIIO::ImageBuf& map)
{
    const int coverage = map.spec().channelindex("coverage"), channels = map.nchannels();
    const auto *a = static_cast<const float*>(other.localpixels()), *b = static_cast<const float*>(truth.localpixels()),
               *texel = static_cast<const float*>(map.localpixels());
    Difference off;
    for (size_t i = 0; i < size_t(truth.spec().image_pixels()); ++i) {
        if (texel[i * size_t(channels) + size_t(coverage)] == 0)
            continue;
        for (size_t c = 3 * i; c < 3 * i + 3; ++c)
            off.add(double(a[c]), double(b[c]));
    }
    return off.mean() > 0 ? off.rms() / off.mean() : 0;
}

} // namespace vmlight::cost
