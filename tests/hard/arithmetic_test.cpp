// SPDX-License-Identifier: Apache-2.0
// Numbers at the ends of their range, sums of many, rotations of many turns.
#include "hard_case.h"

#include <vmlight/rotation.h>

#include <cmath>

using namespace vmlight;
using OIIO::Strutil::fmt::format;

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

std::vector<double> numbers_of(const Rotation& r)
{
    return { r[0][0], r[0][1], r[0][2], r[1][0], r[1][1], r[1][2], r[2][0], r[2][1], r[2][2] };
}

} // namespace

TEST(Arithmetic, TenThousandTurnsAreOne)
{
    HardCase row("Ten thousand turns of 0.036 degrees are composed, as a turntable's are");
    const Rotation step = rotation_from_angles(0, 0.036, 0);
    Imath::M33f in_float;
    Rotation in_double, mended;
    for (int turn = 0; turn < 10000; ++turn) {
        in_float = Imath::M33f(step) * in_float;
        in_double = step * in_double;
    }
    EXPECT_GT(distance_from_orthonormal(Rotation(in_float)), 2e-4);
    row.naive("in float, stretches directions by more than 1e-4");
    std::string error;
    EXPECT_FALSE(rotation_from_matrix(mended, numbers_of(Rotation(in_float)), error));
    EXPECT_NE(error.find("not a rotation: R R^T differs from the identity by"), std::string::npos) << error;
    ASSERT_TRUE(rotation_from_matrix(mended, numbers_of(in_double), error)) << error;
    EXPECT_LT(distance_from_orthonormal(mended), 1e-15);
    EXPECT_NEAR(mended[0][0], 1, 1e-9);
    row.ours("such a matrix is refused with its error; one from double is made orthonormal to 1e-15");
}
