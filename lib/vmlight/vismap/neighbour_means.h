// SPDX-License-Identifier: Apache-2.0
/// What a texel becomes with its neighbours, each by its weight: the weighted sums of reconstruction, a vector kernel.
#pragma once

#include <vmlight/vismap/neighbour_window.h>

namespace vmlight {

/// Set `change` (of the tile, row by row) to the weighted mean of what `plane` has in a texel and its neighbours, less
/// what it has in the texel itself. Exactly 0 where they have the same.
void mean_change(const NeighbourWindow& window, const float* plane, float* change);

/// Set `variance` (of the tile, row by row) to that of the weighted mean, if texels are independent.
void mean_variance(const NeighbourWindow& window, float* variance);

} // namespace vmlight
