// SPDX-License-Identifier: Apache-2.0
#include <vmlight/mesh/import/alembic/transform.h>

#include <vmlight/base/format.h>
#include <vmlight/mesh/import/alembic/error.h>

#include <Imath/ImathMatrixAlgo.h>
#include <Imath/ImathQuat.h>

#include <algorithm>
#include <cmath>
#include <iterator>

namespace vmlight::alembic {
namespace {

using Imath::M44d;
using Imath::Quatd;
using Imath::V3d;

// How many numbers the operations have, by the upper four bits of their code: scale, translate, rotate about an axis,
// matrix, and rotate about x, y, z.
constexpr size_t kNumbers[] = { 3, 3, 4, 16, 1, 1, 1 };
constexpr size_t kMatrix = 3;

M44d rotation(const V3d& axis, double degrees)
{
    M44d matrix;
    return matrix.setAxisAngle(axis, degrees * M_PI / 180);
}

M44d operation(size_t kind, const double* n)
{
    M44d matrix;
    switch (kind) {
    case 0:
        return matrix.setScale(V3d(n[0], n[1], n[2]));
    case 1:
        return matrix.setTranslation(V3d(n[0], n[1], n[2]));
    case 2:
        return rotation(V3d(n[0], n[1], n[2]), n[3]);
    case kMatrix:
        std::copy(n, n + 16, &matrix[0][0]);
        return matrix;
    default:
        return rotation(V3d(kind == 4, kind == 5, kind == 6), n[0]);
    }
}

struct Parts
{
    V3d scale, shear, translation;
    Quatd rotation;
};

bool take_apart(Parts& dst, M44d matrix)
{
    dst.translation = matrix.translation();
    if (!Imath::extractAndRemoveScalingAndShear(matrix, dst.scale, dst.shear, false))
        return false;
    dst.rotation = Imath::extractQuat(matrix).normalized();
    return true;
}

// Between two matrices; number by number where one has no inverse.
void blend_matrices(double* a, const double* b, double weight)
{
    Parts from, to;
    M44d first, second;
    std::copy(a, a + 16, &first[0][0]);
    std::copy(b, b + 16, &second[0][0]);
    if (!take_apart(from, first) || !take_apart(to, second)) {
        for (size_t i = 0; i < 16; ++i)
            a[i] = a[i] * (1 - weight) + b[i] * weight;
        return;
    }
    const auto between = [&](const V3d& v, const V3d& w) { return v * (1 - weight) + w * weight; };
    M44d matrix = Imath::slerpShortestArc(from.rotation, to.rotation, weight).toMatrix44();
    matrix.shear(between(from.shear, to.shear));
    matrix.scale(between(from.scale, to.scale));
    matrix *= M44d().setTranslation(between(from.translation, to.translation));
    std::copy(&matrix[0][0], &matrix[0][0] + 16, a);
}

std::vector<double> read_numbers(const AbcA::CompoundPropertyReaderPtr& xform, int64_t sample)
{
    if (const auto scalar = find_scalar(xform, ".vals"))
        return read_scalar<double>(*scalar, sample);
    return read_array<double>(*find_array(xform, ".vals"), sample);
}

M44d read_matrix(const AbcA::CompoundPropertyReaderPtr& xform, Moment& moment)
{
    const auto operations = find_scalar(xform, ".ops");
    const auto scalar = find_scalar(xform, ".vals");
    const auto array = find_array(xform, ".vals");
    if (!operations || (!scalar && !array))
        return M44d();
    const SamplePair pair = scalar ? samples_at(*scalar, moment) : samples_at(*array, moment);
    const std::vector<double> to = read_numbers(xform, pair.second), from = read_numbers(xform, pair.first);
    std::vector<double> numbers = blend(from, to, pair.weight);
    M44d all;
    size_t at = 0;
    for (const uint8_t code : read_scalar<uint8_t>(*operations, 0)) {
        const size_t kind = code >> 4;
        if (kind >= std::size(kNumbers) || at + kNumbers[kind] > numbers.size())
            throw Error(format("a transform is damaged: operation {} at number {} of {}", kind, at, numbers.size()));
        if (kind == kMatrix && pair.weight > 0 && from.size() == to.size()) {
            std::copy(&from[at], &from[at] + 16, &numbers[at]);
            blend_matrices(&numbers[at], &to[at], pair.weight);
        }
        all = operation(kind, &numbers[at]) * all;
        at += kNumbers[kind];
    }
    return all;
}

} // namespace

Transform read_transform(const AbcA::CompoundPropertyReaderPtr& properties, Moment& moment)
{
    Transform transform;
    const auto xform = find_compound(properties, ".xform");
    transform.exists = xform != nullptr;
    transform.matrix = read_matrix(xform, moment);
    if (const auto inherits = find_scalar(xform, ".inherits")) {
        const std::vector<uint8_t> flag = read_scalar<uint8_t>(*inherits, samples_at(*inherits, moment).first);
        transform.inherits = flag.empty() || flag[0] != 0;
    }
    return transform;
}

} // namespace vmlight::alembic
