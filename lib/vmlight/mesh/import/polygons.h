// SPDX-License-Identifier: Apache-2.0
/// Polygons cut into triangles, for formats that no library reads for us.
#pragma once

#include <Imath/ImathVec.h>

#include <array>
#include <cstdint>
#include <functional>
#include <string>
#include <vector>

namespace vmlight {

/// Called with the index of a polygon and those of three of its corners.
using TriangleVisitor = std::function<void(size_t polygon, const std::array<uint32_t, 3>& corners)>;

/// The corner, 0 or 1, that both triangles of a quad share with the one opposite: 0, unless one of them would face away
/// from the quad as a whole. How much a quad bends makes no difference, so that the poses of a mesh are cut alike.
/// Of corners that are not finite, it is either.
int quad_diagonal(const std::array<Imath::V3d, 4>& corners);

/// Visit the triangles of all polygons, in their order. Polygons may be concave, and need not be plane. Those of fewer
/// than three corners have none; quads are cut at quad_diagonal(); assimp, which cuts the others, may give up on one
/// that crosses itself.
///
/// @param ends         for each polygon, the index of the corner behind its last; its first is the end of the last one
/// @param position     of a corner; need not be finite
/// @param is_far       positions lose their shape in float, unless measured from a corner of their polygon
/// @returns false, with the reason in `error`, if memory is short
bool visit_triangles(const std::vector<uint32_t>& ends, const std::function<Imath::V3d(uint32_t corner)>& position,
                     bool is_far, const TriangleVisitor& visit, std::string& error);

} // namespace vmlight
