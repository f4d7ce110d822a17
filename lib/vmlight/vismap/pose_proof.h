// SPDX-License-Identifier: Apache-2.0
/// Triangles that see the same in two poses: proven, without a ray.
#pragma once

#include <vmlight/trace/pose_motion.h>
#include <vmlight/vismap/normal_map.h>
#include <vmlight/vismap/vismap.h>

#include <cstdint>
#include <vector>

namespace vmlight {

/// Files round normals, mostly to four digits: twice 9e-5. Turned normals that differ by less are the same.
constexpr double kSameNormal = 2.5e-4;

/// For each triangle of the baked mesh, 1 where it, its normals, and all that may rise above its tangent
/// plane within `params.max_distance` move together: what its texels see is then what they saw, turned with it. 0 where
/// that is not so, or not proven. The ground is PoseGround's.
///
/// @param search   whether to look for what rises above each; otherwise only a scene that is one body is proven
std::vector<uint8_t> prove_same_view(const PoseMotion& motion, const VismapParams& params, bool search, int nthreads);

/// For each triangle of the baked mesh, 1 where it stands still with all that its rays are made of: position, normals,
/// the ground. Where rays of its texels meet nothing that moves, they meet what they met.
std::vector<uint8_t> find_still(const PoseMotion& motion, const VismapParams& params);

/// Whether both have normal maps of the same pixels, or neither has one.
bool have_same_normals(const NormalMapPointer& base, const NormalMapPointer& pose);

} // namespace vmlight
