// SPDX-License-Identifier: Apache-2.0
#include <vmlight/trace/instance_plan.h>

#include <vmlight/trace/occluder.h>

#include <Imath/ImathMatrixAlgo.h>

#include <algorithm>
#include <cmath>

namespace vmlight {

using Imath::M33d;
using Imath::M44d;
using Imath::V3d;
using Imath::V3f;

namespace {

// A ray's origin, of coordinates up to 2, is off by at most some 4 roundings (2^-24) times this unevenness, and times
// the size of what is instanced if that is larger: 4 x 2^-24 x 8 x 2 is half of kRayOffset.
constexpr double kUnevenness = 8, kLargestScale = 8;
// Its cube is still a float, and so is the cube of its inverse.
constexpr double kSmallestScale = 1e-10;
// 6 MB in Embree.
constexpr int64_t kFewTriangles = 1 << 16;

} // namespace

V3d InstanceTransform::normal_at(const V3f& normal) const
{
    // By the cofactors of the matrix: its determinant times its inverse, transposed.
    const V3d x(columns[0]), y(columns[1]), z(columns[2]);
    const V3d turned = y.cross(z) * normal.x + z.cross(x) * normal.y + x.cross(y) * normal.z;
    return x.cross(y).dot(z) < 0 ? -turned : turned;
}

bool instance_transform(InstanceTransform& dst, const M44d& to_object, const SceneFrame& local, const SceneFrame& frame)
{
    M33d linear;
    for (int row = 0; row < 3; ++row)
        for (int column = 0; column < 3; ++column) {
            linear[row][column] = to_object[row][column] * frame.scale / local.scale;
            dst.columns[size_t(row)][column] = float(linear[row][column]);
        }
    V3d origin;
    to_object.multVecMatrix(local.centre, origin);
    dst.columns[3] = frame.to_scene(origin);
    for (const V3f& column : dst.columns)
        if (!std::isfinite(column.length2()))
            return false;
    M33d u, v;
    V3d sizes;
    Imath::jacobiSVD(linear, u, sizes, v);
    const double largest = std::max({ sizes.x, sizes.y, sizes.z }), smallest = std::min({ sizes.x, sizes.y, sizes.z });
    return smallest >= kSmallestScale && largest <= kLargestScale && largest <= kUnevenness * smallest;
}

bool are_many(const MeshInstances& instances)
{
    return instances.triangles() > kFewTriangles;
}

} // namespace vmlight
