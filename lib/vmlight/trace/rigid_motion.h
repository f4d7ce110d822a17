// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vmlight/math/rotation.h>

#include <Imath/ImathVec.h>

#include <vector>

namespace vmlight {

/// x -> R x + t.
struct RigidMotion
{
    Rotation turn;
    Imath::V3d shift { 0 };

    Imath::V3d operator()(const Imath::V3d& p) const { return rotate(turn, p) + shift; }
};

/// Whether R is the identity: nothing turns.
bool is_straight(const Rotation& turn);

/// The motion that takes the points of `from` nearest to those of `to`, by least squares. Source: P. Schoenemann, "A
/// generalized solution of the orthogonal Procrustes problem", 1966 (Imath's implementation).
RigidMotion nearest_motion(const std::vector<Imath::V3d>& from, const std::vector<Imath::V3d>& to);

/// The rotation that takes one pair of unit vectors, at right angles, to another.
Rotation rotation_between(const Imath::V3d& normal, const Imath::V3d& side, const Imath::V3d& normal_to,
                          const Imath::V3d& side_to);

} // namespace vmlight
