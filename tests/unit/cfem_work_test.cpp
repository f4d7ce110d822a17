// SPDX-License-Identifier: Apache-2.0
#include "cfem_maps.h"

#include <vmlight/cfem/kernel.h>

#include <gtest/gtest.h>

using namespace cfem_maps;

// How the work is done.

TEST(Cfem, SamePixelsForAnyNumberOfThreads)
{
    Map map = random_map(300, 150, 12);
    map.at(17, 60)[2] = 1e5f;
    for (const CfemParams& params : { exact(32, 16), exact(31, 9), harmonics(9, 32, 16) }) {
        const Map one = filtered(image(map), params, 1);
        EXPECT_EQ(filtered(image(map), params, 2).rgb, one.rgb);
        EXPECT_EQ(filtered(image(map), params, 7).rgb, one.rgb);
    }
}

TEST(Cfem, ProgressRisesToOneAndStopsTheWork)
{
    const OIIO::ImageBuf env = image(random_map(600, 300, 13));
    for (const CfemParams& params : { exact(16, 8), harmonics(4, 16, 8) }) {
        OIIO::ImageBuf dst;
        double last = 0;
        ASSERT_TRUE(make_cfem(dst, env, params, 1, [&](double done) {
            EXPECT_GE(done, last);
            last = done;
            return true;
        }));
        EXPECT_DOUBLE_EQ(last, 1);
        EXPECT_FALSE(make_cfem(dst, env, params, 1, [](double done) { return done < 0.5; }));
        EXPECT_EQ(dst.geterror(), "interrupted");
        EXPECT_EQ(dst.spec().width, 0);
    }
}

TEST(Cfem, VectorKernelAgreesWithScalar)
{
    std::mt19937 random(2);
    const auto number = [&] { return double(random()) / double(std::mt19937::max()) * 2 - 1; };
    std::vector<PrefixCell> cells(66);
    for (PrefixCell& cell : cells)
        for (int i = 0; i < 4; ++i)
            cell.zero[i] = number(), cell.slope[i] = number(), cell.cosine[i] = number(), cell.sine[i] = number();
    std::vector<ColumnAngle> columns(33);
    for (int c = 0; c < 33; ++c)
        columns[c] = { number(), number(), number() };
    std::vector<ColumnSum> scalar(33), vector(33);
    for (int repeat = 0; repeat < 100; ++repeat) {
        const ArcRun run { repeat % 5, 33 - repeat % 7, { int64_t(random()), 0 }, int64_t(1) << 32,
                           number(),   number(),        { number(), number() } };
        add_arcs_scalar(scalar.data(), &cells[1], columns.data(), run);
        add_arcs(vector.data(), &cells[1], columns.data(), run);
    }
    // Each of 500 additions of at most 2 rounds once, or twice where multiplication is apart: below 1000 ulps of the
    // largest sum, 64.
    for (int c = 0; c < 33; ++c)
        for (int i = 0; i < 8; ++i)
            EXPECT_NEAR((&scalar[c].half[0][0])[i], (&vector[c].half[0][0])[i], 1000 * 64 * 2.2e-16);
}
