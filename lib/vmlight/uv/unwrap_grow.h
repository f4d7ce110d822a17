// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vmlight/uv/unwrap_chart.h>

#include <cstdint>
#include <vector>

namespace vmlight {

/// Divide the triangles that have an area into connected pieces whose normals are within a cone.
/// @param joined   set for the half-edges inside each piece
std::vector<std::vector<uint32_t>> grow_charts(const UnwrapSurface& surface, JoinedEdges& joined);

/// Divide a chart of two triangles or more into two connected ones, and take the edges between them out of `joined`.
/// Calls with other charts may run at the same time.
std::array<std::vector<uint32_t>, 2> split_chart(const UnwrapChart& chart, const UnwrapSurface& surface,
                                                 JoinedEdges& joined, const std::vector<uint32_t>& place);

} // namespace vmlight
