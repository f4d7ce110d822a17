// SPDX-License-Identifier: Apache-2.0
#include <vmlight/math/rotation.h>

#include <gtest/gtest.h>

#include <cmath>

using namespace vmlight;
using Imath::V3d;

TEST(Rotation, QuarterTurnsAreExact)
{
    EXPECT_EQ(rotate(rotation_from_angles(0, 90, 0), V3d(0, 0, 1)), V3d(1, 0, 0));
    EXPECT_EQ(rotate(rotation_from_angles(90, 0, 0), V3d(0, 1, 0)), V3d(0, 0, 1));
    EXPECT_EQ(rotate(rotation_from_angles(0, 0, 90), V3d(1, 0, 0)), V3d(0, 1, 0));
    EXPECT_EQ(rotate(rotation_from_angles(0, -270, 0), V3d(0, 0, 1)), V3d(1, 0, 0));
    EXPECT_EQ(rotation_from_angles(0, 360 * 1e6, 0), Rotation());
}

TEST(Rotation, AnglesTurnAboutXThenYThenZ)
{
    const Rotation composed = rotation_from_angles(20, 35, -50);
    const V3d v(0.3, -0.7, 0.2);
    const V3d stepwise = rotate(rotation_from_angles(0, 0, -50),
                                rotate(rotation_from_angles(0, 35, 0), rotate(rotation_from_angles(20, 0, 0), v)));
    EXPECT_LT((rotate(composed, v) - stepwise).length(), 1e-15);
}

TEST(Rotation, MatrixIsRowMajorForColumnVectors)
{
    Rotation r;
    std::string error;
    ASSERT_TRUE(rotation_from_matrix(r, { 0, 0, 1, 0, 1, 0, -1, 0, 0 }, error)) << error;
    EXPECT_LT((rotate(r, V3d(0, 0, 1)) - V3d(1, 0, 0)).length(), 1e-15);
}

TEST(Rotation, NearRotationIsMadeOrthonormal)
{
    Rotation r;
    std::string error;
    ASSERT_TRUE(rotation_from_matrix(r, { 1 + 3e-5, 2e-5, 0, 0, 1, 1e-5, 0, 0, 1 - 2e-5 }, error)) << error;
    for (int i = 0; i < 3; ++i)
        for (int j = 0; j < 3; ++j) {
            const double dot = r[i][0] * r[j][0] + r[i][1] * r[j][1] + r[i][2] * r[j][2];
            EXPECT_NEAR(dot, i == j ? 1 : 0, 1e-15);
        }
}

TEST(Rotation, MirrorsScalesAndShearsAreRefused)
{
    Rotation r;
    std::string error;
    EXPECT_FALSE(rotation_from_matrix(r, { -1, 0, 0, 0, 1, 0, 0, 0, 1 }, error));
    EXPECT_NE(error.find("a reflection"), std::string::npos) << error;
    EXPECT_FALSE(rotation_from_matrix(r, { 2, 0, 0, 0, 2, 0, 0, 0, 2 }, error));
    EXPECT_NE(error.find("not a rotation"), std::string::npos) << error;
    EXPECT_FALSE(rotation_from_matrix(r, { 1, 0.01, 0, 0, 1, 0, 0, 0, 1 }, error));
    EXPECT_FALSE(rotation_from_matrix(r, { NAN, 0, 0, 0, 1, 0, 0, 0, 1 }, error));
    EXPECT_FALSE(rotation_from_matrix(r, { 1, 2, 3 }, error));
    EXPECT_NE(error.find("3 numbers, expected 9"), std::string::npos) << error;
}

TEST(Rotation, QuaternionOfAnyLengthTurnsAlike)
{
    const double h = std::sqrt(0.5);
    for (double scale : { 1.0, 1e-200, 1e200, -3.0 }) {
        Rotation r;
        std::string error;
        ASSERT_TRUE(rotation_from_quaternion(r, { h * scale, 0, h * scale, 0 }, error)) << error;
        EXPECT_LT((rotate(r, V3d(0, 0, 1)) - V3d(1, 0, 0)).length(), 1e-15) << scale;
    }
    Rotation r;
    std::string error;
    EXPECT_FALSE(rotation_from_quaternion(r, { 0, 0, 0, 0 }, error));
    EXPECT_FALSE(rotation_from_quaternion(r, { NAN, 0, 0, 1 }, error));
}
