// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vmlight/uv/unwrap.h>
#include <vmlight/uv/unwrap_chart.h>

#include <vector>

namespace vmlight {

/// Place charts in the map, all at the largest scale at which they fit: their shapes, not their bounds, are what must
/// not meet. Sets their uvs to texels, x right and y up.
/// @param density  set to the texels per unit of length of the charts
/// @returns false if they do not fit at any scale
bool pack_charts(std::vector<UnwrapChart>& charts, const UnwrapParams& params, double& density);

/// The texels between charts.
int unwrap_gap(const UnwrapParams& params);

} // namespace vmlight
