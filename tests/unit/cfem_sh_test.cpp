// SPDX-License-Identifier: Apache-2.0
#include "cfem_maps.h"

#include <vmlight/cfem/spherical_harmonics.h>
#include <vmlight/math/harmonics.h>

#include <gtest/gtest.h>

#include <array>

using namespace cfem_maps;

namespace {

// The first nine in closed form, in the frame of latlong.h, by (l, m) at l^2 + l + m. With phi = 2 pi s,
// sin theta cos phi = -z and sin theta sin phi = x.
std::array<double, 9> nine_harmonics(const V3d& w)
{
    const double one = std::sqrt(3 / (4 * pi)), two = std::sqrt(15 / (4 * pi));
    return { std::sqrt(1 / (4 * pi)),
             one * w.x,
             one * w.y,
             one * -w.z,
             two * w.x * -w.z,
             two * w.y * w.x,
             std::sqrt(5 / (16 * pi)) * (3 * w.y * w.y - 1),
             two * w.y * -w.z,
             two / 2 * (w.z * w.z - w.x * w.x) };
}

// Red of the coefficients measured for the light in Grace Cathedral: Ramamoorthi and Hanrahan, 2001.
constexpr double kGrace[9] = { .79, .39, -.34, -.29, -.11, -.26, -.16, .56, .21 };

} // namespace

TEST(CfemHarmonics, NineCoefficientsComeBackAndFilterByTheirBands)
{
    const Map map = sampled(512, 256, [](const V3d& w) {
        const std::array<double, 9> y = nine_harmonics(w);
        double sum = 3; // so that nothing is negative
        for (int i = 0; i < 9; ++i)
            sum += kGrace[i] * y[i];
        return V3d(sum);
    });
    const auto read = [&](int row, float* rgb) {
        std::copy_n(map.at(0, row), 3 * map.width, rgb);
        return true;
    };
    std::vector<double> c;
    ASSERT_TRUE(project_harmonics(c, 5, { 512, 256, false }, read, 1, {}));
    // Constant pixels stand for a harmonic to the square of their size.
    for (int i = 0; i < 25; ++i)
        EXPECT_NEAR(c[3 * i + 1], (i < 9 ? kGrace[i] : 0) + (i == 0 ? 3 * std::sqrt(4 * pi) : 0), 5e-5) << i;

    const Map cfem = filtered(image(map), harmonics(3, 32, 16));
    EXPECT_LT(largest_error(cfem,
                            [](const V3d& n) {
                                const double band[3] = { 1, 2.0 / 3, 0.25 };
                                const std::array<double, 9> y = nine_harmonics(n);
                                double sum = 3;
                                for (int i = 0; i < 9; ++i)
                                    sum += band[i < 1 ? 0 : i < 4 ? 1 : 2] * kGrace[i] * y[i];
                                return V3d(sum);
                            }),
              5e-5);
    EXPECT_LT(largest_difference(cfem, filtered(map, 32, 16)), 5e-5);
}

TEST(CfemHarmonics, BandsScaleByTheCosineLobesSpectrum)
{
    const double want[] = { 1, 2.0 / 3, 0.25, 0, -1.0 / 24, 0, 1.0 / 64, 0, -1.0 / 128, 0, 7.0 / 1536 };
    for (int l = 0; l < 11; ++l)
        EXPECT_NEAR(cosine_eigenvalue(l), want[l], 1e-15) << l;
}

TEST(CfemHarmonics, HighBandsAreOrthonormal)
{
    // One harmonic in, one out. 256 rows sample band 40 with an error of (40 pi / 256)^2 / 12 or so.
    const int order = 64;
    std::vector<double> in(3 * order * order), rgb, out;
    in[3 * (40 * 40 + 40 + 17)] = 1;
    in[3 * (63 * 63 + 63 - 63) + 1] = 1;
    evaluate_harmonics(rgb, { 256, 128 }, in, order, 2);
    const auto read = [&](int row, float* pixels) {
        std::copy_n(&rgb[3 * 256 * row], 3 * 256, pixels);
        return true;
    };
    ASSERT_TRUE(project_harmonics(out, order, { 256, 128, false }, read, 2, {}));
    for (size_t i = 0; i < in.size(); ++i)
        EXPECT_NEAR(out[i], in[i], 0.15) << i / 3;
}

TEST(CfemHarmonics, RingBelowZeroUnderASun)
{
    Map map(64, 32);
    std::fill_n(map.at(10, 10), 3, 1e4f);
    const Map cfem = filtered(image(map), harmonics(3, 32, 16));
    EXPECT_LT(*std::min_element(cfem.rgb.begin(), cfem.rgb.end()), -0.05 * brute::mean(map)[0]);
}
