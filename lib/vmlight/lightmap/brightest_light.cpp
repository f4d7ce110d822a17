// SPDX-License-Identifier: Apache-2.0
#include <vmlight/lightmap/brightest_light.h>

#include <vmlight/cfem/cfem.h>

#include <algorithm>
#include <limits>

namespace vmlight {

void find_brightest_light(float rgb[3], const OIIO::ImageBuf& radiance)
{
    CfemParams params;
    params.resolution = { 64, 32 };
    params.sanitize = true;
    OIIO::ImageBuf cfem;
    // On one thread: the caller may hold a lock. If it is too bright for float, the result is reported elsewhere.
    const bool made = make_cfem(cfem, radiance, params, 1);
    std::fill_n(rgb, 3, made ? 0 : std::numeric_limits<float>::infinity());
    const auto* pixel = static_cast<const float*>(cfem.localpixels());
    for (int i = 0; made && i < params.resolution.width * params.resolution.height; ++i, pixel += 3)
        for (int c = 0; c < 3; ++c)
            rgb[c] = std::max(rgb[c], pixel[c]);
}

} // namespace vmlight
