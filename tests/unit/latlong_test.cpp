// SPDX-License-Identifier: Apache-2.0
#include <vmlight/math/latlong.h>

#include <gtest/gtest.h>

using namespace vmlight;
using Imath::V3d;

namespace {

void expect_direction(const V3d& d, double x, double y, double z)
{
    EXPECT_NEAR(d.x, x, 1e-15);
    EXPECT_NEAR(d.y, y, 1e-15);
    EXPECT_NEAR(d.z, z, 1e-15);
}

} // namespace

TEST(Latlong, CentreLooksAlongPlusZAndAQuarterAlongPlusX)
{
    expect_direction(latlong::direction(0.5, 0.5), 0, 0, 1);
    expect_direction(latlong::direction(0.25, 0.5), 1, 0, 0);
    expect_direction(latlong::direction(0.75, 0.5), -1, 0, 0);
    expect_direction(latlong::direction(0.0, 0.5), 0, 0, -1);
    expect_direction(latlong::direction(0.3, 0.0), 0, 1, 0);
    expect_direction(latlong::direction(0.3, 1.0), 0, -1, 0);
}

TEST(Latlong, PositionInvertsDirection)
{
    for (int i = 0; i < 1000; ++i) {
        const double s = std::fmod(i * 0.6180339887498949, 1.0), t = (i + 0.5) / 1000;
        const auto back = latlong::position(latlong::direction(s, t) * 7.5);
        EXPECT_NEAR(back.x, s, 1e-13 / std::sin(latlong::pi * t)) << s << ", " << t;
        EXPECT_NEAR(back.y, t, 1e-14) << s << ", " << t;
    }
}

TEST(Latlong, PositionKeepsItsDigitsNearThePole)
{
    // acos(y) in float would be off by up to 5e-4 radians here.
    const float tiny = 1e-4f;
    EXPECT_NEAR(latlong::position(Imath::V3f(0, 1, tiny)).y, tiny / latlong::pi, 3e-8);
}

TEST(Latlong, SeamStaysInsideTheMap)
{
    for (float x : { 1e-9f, -1e-9f, 1e-30f, -1e-30f, 0.0f, -0.0f }) {
        const float s = latlong::position(Imath::V3f(x, 0, -1)).x;
        EXPECT_GE(s, 0.0f) << x;
        EXPECT_LT(s, 1.0f) << x;
    }
    EXPECT_EQ(latlong::position(Imath::V3f(0, 0, 0)), Imath::V2f(0.5f, 0.5f));
}

TEST(Latlong, RowsSumToTheSphere)
{
    for (int height : { 1, 2, 3, 128, 8192 }) {
        double sum = 0;
        for (int row = 0; row < height; ++row)
            sum += latlong::row_solid_angle(row, height);
        EXPECT_NEAR(sum, 4 * latlong::pi, 1e-12) << height;
    }
}
