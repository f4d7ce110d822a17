// SPDX-License-Identifier: Apache-2.0
/// Rotations from object space to environment space: the light from object direction w is L(R w). Matrices multiply
/// column vectors (see rotate()), unlike Imath's operators.
#pragma once

#include <vmlight/base/export.h>

#include <Imath/ImathMatrix.h>
#include <Imath/ImathVec.h>

#include <string>
#include <vector>

namespace vmlight {

/// A rotation R, row major, for column vectors: (R v)[i] = sum_j m[i][j] v[j].
using Rotation = Imath::M33d;

/// R v.
template <class T> inline Imath::Vec3<T> rotate(const Rotation& r, const Imath::Vec3<T>& v)
{
    return Imath::Vec3<T>(T(r[0][0] * v.x + r[0][1] * v.y + r[0][2] * v.z),
                          T(r[1][0] * v.x + r[1][1] * v.y + r[1][2] * v.z),
                          T(r[2][0] * v.x + r[2][1] * v.y + r[2][2] * v.z));
}

/// Degrees about fixed x, then y, then z: Rz Ry Rx. Multiples of 90 degrees are exact.
VMLIGHT_API Rotation rotation_from_angles(double x, double y, double z);

/// From nine numbers, row major, for column vectors. They must be a rotation, |R R^T - I| < 1e-4 in every entry and
/// determinant > 0, and are made orthonormal (polar decomposition). Otherwise returns false, with the reason in
/// `error`.
VMLIGHT_API bool rotation_from_matrix(Rotation& dst, const std::vector<double>& numbers, std::string& error);

/// From a quaternion [w, x, y, z] of any non-zero length. Returns false, with the reason in `error`, if it is zero or
/// not finite.
VMLIGHT_API bool rotation_from_quaternion(Rotation& dst, const std::vector<double>& wxyz, std::string& error);

} // namespace vmlight
