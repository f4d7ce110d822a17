// SPDX-License-Identifier: Apache-2.0
#include <vmlight/trace/rigid_motion.h>

#include <Imath/ImathMatrixAlgo.h>

#include <array>

namespace vmlight {

using Imath::V3d;

bool is_straight(const Rotation& turn)
{
    return turn == Rotation();
}

RigidMotion nearest_motion(const std::vector<V3d>& from, const std::vector<V3d>& to)
{
    // Of row vectors.
    const Imath::M44d matrix = Imath::procrustesRotationAndTranslation(from.data(), to.data(), from.size());
    RigidMotion motion;
    for (int i = 0; i < 3; ++i)
        for (int j = 0; j < 3; ++j)
            motion.turn[i][j] = matrix[j][i];
    motion.shift = V3d(matrix[3][0], matrix[3][1], matrix[3][2]);
    return motion;
}

Rotation rotation_between(const V3d& normal, const V3d& side, const V3d& normal_to, const V3d& side_to)
{
    const std::array<V3d, 3> from { side, normal.cross(side), normal };
    const std::array<V3d, 3> to { side_to, normal_to.cross(side_to), normal_to };
    Rotation turn;
    for (int i = 0; i < 3; ++i)
        for (int j = 0; j < 3; ++j) {
            turn[i][j] = 0;
            for (size_t axis = 0; axis < 3; ++axis)
                turn[i][j] += to[axis][i] * from[axis][j];
        }
    return turn;
}

} // namespace vmlight
