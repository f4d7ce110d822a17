// SPDX-License-Identifier: Apache-2.0
#include <vmlight/image/primaries.h>

#include <vmlight/image/color_space.h>

#include <algorithm>
#include <cmath>

namespace vmlight {
namespace {

using Vector = std::array<double, 3>;
using Matrix = std::array<double, 9>; // row by row

Vector operator*(const Matrix& m, const Vector& v)
{
    Vector product {};
    for (size_t i = 0; i < 3; ++i)
        product[i] = m[3 * i] * v[0] + m[3 * i + 1] * v[1] + m[3 * i + 2] * v[2];
    return product;
}

Matrix operator*(const Matrix& a, const Matrix& b)
{
    Matrix product {};
    for (size_t i = 0; i < 3; ++i)
        for (size_t j = 0; j < 3; ++j)
            for (size_t k = 0; k < 3; ++k)
                product[3 * i + j] += a[3 * i + k] * b[3 * k + j];
    return product;
}

Matrix inverse(const Matrix& m)
{
    const auto minor = [&](size_t i, size_t j) {
        const size_t a = (i + 1) % 3, b = (i + 2) % 3, c = (j + 1) % 3, d = (j + 2) % 3;
        return m[3 * a + c] * m[3 * b + d] - m[3 * a + d] * m[3 * b + c];
    };
    const double determinant = m[0] * minor(0, 0) + m[1] * minor(0, 1) + m[2] * minor(0, 2);
    Matrix result;
    for (size_t i = 0; i < 3; ++i)
        for (size_t j = 0; j < 3; ++j)
            result[3 * i + j] = minor(j, i) / determinant;
    return result;
}

Matrix diagonal(const Vector& v)
{
    return { v[0], 0, 0, 0, v[1], 0, 0, 0, v[2] };
}

// XYZ of the chromaticity xy, with Y = 1.
Vector xyz_of(double x, double y)
{
    return { x / y, 1, (1 - x - y) / y };
}

const Vector kD65 = xyz_of(0.3127, 0.329);

bool is_xyz(const LinearSpace& space)
{
    return space.chromaticities[0] == 1;
}

// XYZ is of a D65 white, whatever white makes its matrix the identity.
Vector white_of(const LinearSpace& space)
{
    return is_xyz(space) ? kD65 : xyz_of(space.chromaticities[6], space.chromaticities[7]);
}

Matrix to_xyz(const LinearSpace& space)
{
    if (is_xyz(space))
        return diagonal({ 1, 1, 1 });
    const auto& xy = space.chromaticities;
    Matrix primaries; // its columns are of Y = y, not 1: blue of AP0 has a negative y, and none may be divided by
    for (size_t c = 0; c < 3; ++c) {
        primaries[c] = xy[2 * c];
        primaries[3 + c] = xy[2 * c + 1];
        primaries[6 + c] = 1.0 - xy[2 * c] - xy[2 * c + 1];
    }
    return primaries * diagonal(inverse(primaries) * white_of(space));
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
    const Matrix bradford { 0.8951, 0.2664, -0.1614, -0.7502, 1.7135, 0.0367, 0.0389, -0.0685, 1.0296 };
    const Vector source = bradford * white_of(from), target = bradford * white_of(to);
    const Vector gain { target[0] / source[0], target[1] / source[1], target[2] / source[2] };
    return inverse(to_xyz(to)) * (inverse(bradford) * diagonal(gain) * bradford) * to_xyz(from);
}

std::array<double, 3> luminance_of_primaries(const LinearSpace& space)
{
    const Matrix xyz = to_xyz(space);
    return { xyz[3], xyz[4], xyz[5] };
}

} // namespace vmlight
