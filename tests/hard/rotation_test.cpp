// SPDX-License-Identifier: Apache-2.0
// Rotations of many turns, of none, of half a one; and matrices that are none.
#include "hard_case.h"

#include "lightmap_scene.h"

#include <vmlight/math/rotation.h>

#include <cmath>

using namespace vmlight;

namespace {

// Largest entry of |R R^T - I|.
double distance_from_orthonormal(const Rotation& r)
{
    double worst = 0;
    for (int i = 0; i < 3; ++i)
        for (int j = 0; j < 3; ++j) {
            double dot = 0;
            for (int k = 0; k < 3; ++k)
                dot += r[i][k] * r[j][k];
            worst = std::max(worst, std::abs(dot - (i == j)));
        }
    return worst;
}

double distance(const Rotation& a, const Rotation& b)
{
    double worst = 0;
    for (int i = 0; i < 9; ++i)
        worst = std::max(worst, std::abs(a[i / 3][i % 3] - b[i / 3][i % 3]));
    return worst;
}

std::vector<double> numbers_of(const Rotation& r)
{
    return { r[0][0], r[0][1], r[0][2], r[1][0], r[1][1], r[1][2], r[2][0], r[2][1], r[2][2] };
}

} // namespace

TEST(Arithmetic, TenThousandTurnsAreOne)
{
    HardCase row("Ten thousand rotations of 0.036 degrees composed, as a turntable might");
    const Rotation step = rotation_from_angles(0, 0.036, 0);
    Imath::M33f in_float;
    Rotation in_double, mended;
    for (int turn = 0; turn < 10000; ++turn) {
        in_float = Imath::M33f(step) * in_float;
        in_double = step * in_double;
    }
    EXPECT_GT(distance_from_orthonormal(Rotation(in_float)), 2e-4);
    row.naive("in float, directions stretch by more than 1e-4");
    std::string error;
    EXPECT_FALSE(rotation_from_matrix(mended, numbers_of(Rotation(in_float)), error));
    EXPECT_NE(error.find("not a rotation: R R^T differs from the identity by"), std::string::npos) << error;
    ASSERT_TRUE(rotation_from_matrix(mended, numbers_of(in_double), error)) << error;
    EXPECT_LT(distance_from_orthonormal(mended), 1e-15);
    EXPECT_LT(distance(mended, Rotation()), 1e-9);
    row.ours("such a matrix is refused, with its error; a matrix composed in double is orthonormalised to 1e-15");
}

TEST(Arithmetic, RotationsNearTheIdentity)
{
    HardCase row("A rotation by a millionth of a degree");
    const double degrees = 1e-6;
    const Rotation truth = rotation_from_angles(0, degrees, 0);
    const Imath::M33f rounded(truth);
    const double angle = std::acos((rounded[0][0] + rounded[1][1] + rounded[2][2] - 1) / 2);
    EXPECT_EQ(angle, 0);
    row.naive("its angle as acos of the trace, in float: 0 or NaN");
    Rotation matrix, quaternion;
    std::string error;
    const double half = degrees / 2 * latlong::pi / 180;
    ASSERT_TRUE(rotation_from_matrix(matrix, numbers_of(Rotation(rounded)), error)) << error;
    ASSERT_TRUE(rotation_from_quaternion(quaternion, { std::cos(half), 0, std::sin(half), 0 }, error)) << error;
    EXPECT_NEAR(matrix[0][2], truth[0][2], 1e-7 * truth[0][2]);
    EXPECT_LT(distance(quaternion, truth), 1e-16);
    row.ours("kept to float rounding of the nine numbers; no angle is ever computed");
}

TEST(Arithmetic, HalfATurn)
{
    HardCase row("A rotation by 180 degrees, about each axis and about (1, 2, 2)/3");
    EXPECT_NE(std::sin(latlong::pi), 0);
    const Rotation about(1 - 16.0 / 9, 4.0 / 9, 4.0 / 9, 4.0 / 9, 8.0 / 9 - 1, 8.0 / 9, 4.0 / 9, 8.0 / 9, 8.0 / 9 - 1);
    const double trace = about[0][0] + about[1][1] + about[2][2];
    EXPECT_LT(std::abs(1 + trace), 1e-15);
    row.naive("sin 180 is 1.2e-16; converting the matrix to a quaternion divides by sqrt(1 + trace) = 0");
    EXPECT_EQ(distance(rotation_from_angles(180, 0, 0), Rotation(1, 0, 0, 0, -1, 0, 0, 0, -1)), 0);
    EXPECT_EQ(distance(rotation_from_angles(0, -180, 0), Rotation(-1, 0, 0, 0, 1, 0, 0, 0, -1)), 0);
    EXPECT_EQ(distance(rotation_from_angles(0, 0, 540), Rotation(-1, 0, 0, 0, -1, 0, 0, 0, 1)), 0);
    Rotation matrix, quaternion;
    std::string error;
    ASSERT_TRUE(rotation_from_matrix(matrix, numbers_of(about), error)) << error;
    ASSERT_TRUE(rotation_from_quaternion(quaternion, { 0, 1, 2, 2 }, error)) << error;
    EXPECT_LT(distance(matrix, about), 1e-15);
    EXPECT_LT(distance(quaternion, about), 1e-15);
    row.ours("exact about the axes, within 1e-15 elsewhere");
}

TEST(Arithmetic, MatricesThatAreNoRotations)
{
    HardCase row("A mirror, a scale, a shear, zeros or NaN given as a rotation",
                 "three.js PR#27758, cmgen `mirror`: environments turned inside out");
    const std::vector<double> table[]
        = { { 1, 0, 0, 0, 1, 0, 0, 0, -1 }, { 2, 0, 0, 0, 2, 0, 0, 0, 2 },   { 1, 0.1, 0, 0, 1, 0, 0, 0, 1 },
            { 0, 0, 0, 0, 0, 0, 0, 0, 0 },  { 1, 0, 0, 0, NAN, 0, 0, 0, 1 }, { 1, 0, 0, 0, INFINITY, 0, 0, 0, 1 } };
    row.naive("a mirrored world, wrong brightness or NaN, without a warning");
    for (const auto& numbers : table) {
        LightmapParams params;
        params.matrix = numbers;
        OIIO::ImageBuf dst;
        EXPECT_FALSE(make_lightmap(dst, scene::random_vismap(4, 4), scene::random_cfem(4, 2), params));
        EXPECT_EQ(dst.geterror().rfind("matrix: ", 0), 0u);
    }
    Rotation unused;
    std::string error;
    for (const auto& wxyz : { std::vector<double> { 0, 0, 0, 0 }, { NAN, 0, 0, 1 }, { 1, 2, 3 } })
        EXPECT_FALSE(rotation_from_quaternion(unused, wxyz, error));
    row.ours("refused, with its distance from a rotation");
}
