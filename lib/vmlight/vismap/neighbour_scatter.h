// SPDX-License-Identifier: Apache-2.0
/// Whether the texels around one differ by more than chance.
#pragma once

#include <vector>

namespace vmlight {

struct NeighbourWindow;

/// Set `evenness` (of the tile, row by row) to 1 where V and B' of the up to 9x9 texels around scatter by little more
/// than the variance of their rays explains, and to 0 where they scatter by far more: shadows, creases, other sides.
///
/// So many texels show it far better than the patches of two. @see weigh_neighbours()
void find_evenness(const NeighbourWindow& window, std::vector<float>& evenness);

} // namespace vmlight
