// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vmlight/uv/unwrap_chart.h>

#include <vector>

namespace vmlight {

/// Join charts that are laid flat to neighbours along a border, as when a box unfolds, where they stay flat without
/// overlap and take less room together than apart, each with its margin.
/// @param gap      between charts, in units of length on the surface: about as they will be in the map
void merge_charts(std::vector<UnwrapChart>& charts, const UnwrapSurface& surface, JoinedEdges& joined,
                  std::vector<uint32_t>& place, double gap, int nthreads);

} // namespace vmlight
