// SPDX-License-Identifier: Apache-2.0
#include <vmlight/image/primaries.h>

#include <vmlight/image/color_space.h>

#include <Imath/ImathMatrix.h>
#include <Imath/ImathVec.h>

#include <algorithm>
#include <cmath>

namespace vmlight {
namespace {

using Imath::M33d; // here of column vectors
using Imath::V3d;

V3d product(const M33d& m, const V3d& v)
{
    return v * m.transposed();
}

M33d diagonal(const V3d& v)
{
    return { v.x, 0, 0, 0, v.y, 0, 0, 0, v.z };
}

// XYZ of the chromaticity xy, with Y = 1.
V3d xyz_of(double x, double y)
{
    return { x / y, 1, (1 - x - y) / y };
}

const V3d kD65 = xyz_of(0.3127, 0.329);

bool is_xyz(const LinearSpace& space)
{
    return space.chromaticities[0] == 1;
}

// XYZ is of a D65 white, whatever white makes its matrix the identity.
V3d white_of(const LinearSpace& space)
{
    return is_xyz(space) ? kD65 : xyz_of(space.chromaticities[6], space.chromaticities[7]);
}

M33d to_xyz(const LinearSpace& space)
{
    if (is_xyz(space))
        return {};
    const auto& xy = space.chromaticities;
    M33d primaries; // its columns are of Y = y, not 1: blue of AP0 has a negative y, and none may be divided by
    for (int c = 0; c < 3; ++c) {
        const double x = xy[size_t(2 * c)], y = xy[size_t(2 * c + 1)];
        primaries[0][c] = x;
        primaries[1][c] = y;
        primaries[2][c] = 1.0 - x - y;
    }
    return primaries * diagonal(product(primaries.inverse(), white_of(space)));
}

} // namespace

const std::vector<LinearSpace>& linear_spaces()
{
    static const std::vector<LinearSpace> spaces {
        { "lin_ap1_scene",
          { "lin_ap1_scene", "lin_ap1", "ACEScg", "ACES - ACEScg" },
          { 0.713f, 0.293f, 0.165f, 0.83f, 0.128f, 0.044f, 0.32168f, 0.33767f } },
        { "lin_ap0_scene",
          { "lin_ap0_scene", "lin_ap0", "ACES2065-1", "ACES - ACES2065-1" },
          { 0.7347f, 0.2653f, 0.0f, 1.0f, 0.0001f, -0.077f, 0.32168f, 0.33767f } },
        { kLinearRec709,
          { kLinearRec709, "lin_rec709", "lin_srgb", "Linear Rec.709 (sRGB)", "Utility - Linear - sRGB" },
          { 0.64f, 0.33f, 0.3f, 0.6f, 0.15f, 0.06f, 0.3127f, 0.329f } },
        { "lin_p3d65_scene",
          { "lin_p3d65_scene", "lin_p3d65", "Linear P3-D65", "Utility - Linear - P3-D65" },
          { 0.68f, 0.32f, 0.265f, 0.69f, 0.15f, 0.06f, 0.3127f, 0.329f } },
        { "lin_rec2020_scene",
          { "lin_rec2020_scene", "lin_rec2020", "Linear Rec.2020", "Utility - Linear - Rec.2020" },
          { 0.708f, 0.292f, 0.17f, 0.797f, 0.131f, 0.046f, 0.3127f, 0.329f } },
        { "lin_ciexyzd65_scene",
          { "lin_ciexyzd65_scene", "CIE XYZ-D65 - Scene-referred" },
          { 1.0f, 0.0f, 0.0f, 1.0f, 0.0f, 0.0f, 0.333333f, 0.333333f } },
    };
    return spaces;
}

const LinearSpace* linear_space_named(const std::string& name)
{
    for (const LinearSpace& space : linear_spaces())
        if (is_any_of(name, { space.names.begin(), space.names.end() }))
            return &space;
    return nullptr;
}

const LinearSpace* linear_space_with(const std::array<float, 8>& chromaticities)
{
    constexpr float kRounding = 0.0015f; // files round to three digits, and D65 is written in several ways
    const auto near = [](float a, float b) { return std::abs(a - b) <= kRounding; };
    for (const LinearSpace& space : linear_spaces())
        if (std::equal(chromaticities.begin(), chromaticities.end(), space.chromaticities.begin(), near))
            return &space;
    return nullptr;
}

std::array<double, 9> matrix_between(const LinearSpace& from, const LinearSpace& to)
{
    const M33d bradford(0.8951, 0.2664, -0.1614, -0.7502, 1.7135, 0.0367, 0.0389, -0.0685, 1.0296);
    const V3d gain = product(bradford, white_of(to)) / product(bradford, white_of(from));
    const M33d m = to_xyz(to).inverse() * (bradford.inverse() * diagonal(gain) * bradford) * to_xyz(from);
    std::array<double, 9> rows;
    std::copy_n(m.getValue(), rows.size(), rows.begin());
    return rows;
}

std::array<double, 3> luminance_of_primaries(const LinearSpace& space)
{
    const M33d xyz = to_xyz(space);
    return { xyz[1][0], xyz[1][1], xyz[1][2] };
}

} // namespace vmlight
