// SPDX-License-Identifier: Apache-2.0
#include <vmlight/math/rotation.h>

#include <vmlight/base/format.h>
#include <vmlight/math/latlong.h>

#include <algorithm>
#include <cmath>

namespace vmlight {
namespace {

struct SinCos
{
    double sin, cos;
};

// Quarter turns are exact: a turntable at 90 degrees must give the same pixels as swapping axes.
SinCos sin_cos_degrees(double degrees)
{
    const double turn = std::remainder(degrees, 360.0);
    const double quarters = std::nearbyint(turn / 90.0);
    const double rest = (turn - 90.0 * quarters) * latlong::pi / 180.0;
    const double s = std::sin(rest), c = std::cos(rest);
    switch ((int(quarters) + 4) % 4) {
    case 0:
        return { s, c };
    case 1:
        return { c, -s };
    case 2:
        return { -s, -c };
    default:
        return { -c, s };
    }
}

double distance_from_orthonormal(const Rotation& r)
{
    double worst = 0;
    for (int i = 0; i < 3; ++i)
        for (int j = 0; j < 3; ++j) {
            const double dot = r[i][0] * r[j][0] + r[i][1] * r[j][1] + r[i][2] * r[j][2];
            worst = std::max(worst, std::abs(dot - (i == j ? 1.0 : 0.0)));
        }
    return worst;
}

} // namespace

Rotation rotation_from_angles(double x, double y, double z)
{
    const SinCos a = sin_cos_degrees(x), b = sin_cos_degrees(y), c = sin_cos_degrees(z);
    return Rotation(c.cos * b.cos, c.cos * b.sin * a.sin - c.sin * a.cos, c.cos * b.sin * a.cos + c.sin * a.sin,
                    c.sin * b.cos, c.sin * b.sin * a.sin + c.cos * a.cos, c.sin * b.sin * a.cos - c.cos * a.sin, -b.sin,
                    b.cos * a.sin, b.cos * a.cos);
}

bool rotation_from_matrix(Rotation& dst, const std::vector<double>& numbers, std::string& error)
{
    if (numbers.size() != 9) {
        error = format("matrix: {} numbers, expected 9", numbers.size());
        return false;
    }
    Rotation r;
    for (int i = 0; i < 9; ++i)
        r[i / 3][i % 3] = numbers[i];
    const double off = distance_from_orthonormal(r);
    if (!(off < 1e-4)) {
        error
            = format("matrix: not a rotation: R R^T differs from the identity by {:.3g}, at most 1e-4 is allowed", off);
        return false;
    }
    if (!(r.determinant() > 0)) {
        error = format("matrix: a reflection, not a rotation: determinant {:.3g}", r.determinant());
        return false;
    }
    // Newton's iteration for the polar factor converges quadratically: from 1e-4 two steps reach rounding.
    for (int step = 0; step < 3; ++step)
        r = (r + r.inverse().transposed()) * 0.5;
    dst = r;
    return true;
}

bool rotation_from_quaternion(Rotation& dst, const std::vector<double>& wxyz, std::string& error)
{
    if (wxyz.size() != 4) {
        error = format("quaternion: {} numbers, expected 4 (w,x,y,z)", wxyz.size());
        return false;
    }
    const double largest = std::max({ std::abs(wxyz[0]), std::abs(wxyz[1]), std::abs(wxyz[2]), std::abs(wxyz[3]) });
    const bool finite = std::isfinite(wxyz[0] + wxyz[1] + wxyz[2] + wxyz[3]);
    if (!finite || !(largest > 0)) {
        error = format("quaternion: {},{},{},{} is zero or not finite", wxyz[0], wxyz[1], wxyz[2], wxyz[3]);
        return false;
    }
    // Scale first: squares of very small or large numbers underflow or overflow.
    double w = wxyz[0] / largest, x = wxyz[1] / largest, y = wxyz[2] / largest, z = wxyz[3] / largest;
    const double length = std::sqrt(w * w + x * x + y * y + z * z);
    w /= length, x /= length, y /= length, z /= length;
    dst = Rotation(1 - 2 * (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y), 2 * (x * y + w * z),
                   1 - 2 * (x * x + z * z), 2 * (y * z - w * x), 2 * (x * z - w * y), 2 * (y * z + w * x),
                   1 - 2 * (x * x + y * y));
    return true;
}

} // namespace vmlight
