// SPDX-License-Identifier: Apache-2.0
/// Light of one colour, which every filter leaves as it is: a mean of equal values is that value, to the last bit.
#pragma once

#include <vmlight/base/params.h>
#include <vmlight/cfem/environment.h>

#include <OpenImageIO/imagebuf.h>

#include <array>
#include <cstdint>
#include <optional>
#include <vector>

namespace vmlight {

struct OneColor
{
    std::array<float, 3> rgb {};
    /// NaN, infinite and negative values that were repaired.
    int64_t repaired = 0;
};

/// The colour that all pixels of an environment have, if it is one, after the repair of bad values if `sanitize`.
/// Reads rows until one differs; what cannot be read, or is bad and not to be repaired, is left to others to report.
std::optional<OneColor> find_one_color(const Environment& env, bool sanitize);

/// The colour that all pixels of all images have, if it is one, finite and not negative. Reads rows until one differs.
std::optional<std::array<float, 3>> find_one_color(OIIO::cspan<OIIO::ImageBuf> images);

/// Set `rgb` to the pixels of an image of this size and colour.
void fill(std::vector<double>& rgb, const Size& size, const OneColor& color);

} // namespace vmlight
