// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cmath>

namespace vmlight {

/// The largest |B| that a surface of visibility V can have, (2/3) (1 - (1 - V)^(3/2)): what it sees is then a cap
/// around its normal, whose every direction is as near to the mean as can be. 2/3 for V = 1, never above V. Concave, so
/// that means of texels, such as a margin or a mip level, respect it where the texels do.
inline double longest_direction(double visibility)
{
    const double hidden = 1 - std::clamp(visibility, 0.0, 1.0);
    return 2.0 / 3 * (1 - hidden * std::sqrt(hidden));
}

} // namespace vmlight
