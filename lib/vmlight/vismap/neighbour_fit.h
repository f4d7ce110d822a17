// SPDX-License-Identifier: Apache-2.0
/// The slope of V and B' around each texel, and whether the texels around scatter about it by more than chance.
#pragma once

#include <vmlight/vismap/neighbour_window.h>

namespace vmlight {

/// Fit a plane to V and B' of each wanted texel and its neighbours on the surface; sets all of the window's fit.
///
/// So many texels show far better than the patches of two whether they differ by more than chance: a step, a shadow or
/// another side is no plane. @see weigh_neighbours()
void fit_neighbours(NeighbourWindow& window);

} // namespace vmlight
