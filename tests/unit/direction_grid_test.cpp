// SPDX-License-Identifier: Apache-2.0
#include <vmlight/math/direction_grid.h>
#include <vmlight/math/latlong.h>
#include <vmlight/math/packed_visibility.h>
#include <vmlight/math/sampling.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <random>
#include <utility>
#include <vector>

using namespace vmlight;
using namespace vmlight::direction_grid;
using Imath::V3d;
using Imath::V3f;

namespace {

V3f random_direction(std::mt19937& random)
{
    std::normal_distribution<float> normal;
    return V3f(normal(random), normal(random), normal(random)).normalized();
}

// Rays with the density of the cosine around `normal`, those that `open` lets through marked as seen.
template <class Open> VisibilityGrid looking(const V3f& normal, int rays, Open&& open)
{
    const SamplePattern pattern("fibonacci", rays, false);
    RayFan fan(rays);
    pattern.directions(fan, TangentFrame(normal), normal, texel_hash(3, 5, 0));
    const std::vector<uint8_t> asked = fan.lanes;
    for (int ray = 0; ray < rays; ++ray)
        if (!open(V3f(fan.x[ray], fan.y[ray], fan.z[ray])))
            fan.lanes[size_t(ray / 8)] &= uint8_t(~(1 << ray % 8));
    VisibilityGrid grid;
    grid.set_rays(fan, asked);
    return grid;
}

std::vector<uint32_t> codes(const std::vector<float>& packed)
{
    std::vector<uint32_t> result;
    for (const float value : packed) {
        EXPECT_EQ(value, std::floor(value));
        EXPECT_TRUE(value >= 0 && value < 0x1p24f) << value;
        result.push_back(uint32_t(value));
    }
    return result;
}

template <class Open> std::array<MaskColumn, kColumns> mask_of(const V3f& normal, int rays, Open&& open)
{
    std::vector<float> packed(kMaskFloats);
    looking(normal, rays, open).mask(packed.data(), V3d(normal), V3d(normal));
    std::array<MaskColumn, kColumns> columns;
    for (int c = 0; c < kColumns; ++c)
        columns[size_t(c)] = unpack_mask(codes(packed).data(), c);
    return columns;
}

template <class Open> std::vector<int> cells_of(const V3f& normal, int rays, Open&& open)
{
    std::vector<float> packed(kCellsFloats);
    looking(normal, rays, open).cells(packed.data(), V3d(normal), V3d(normal));
    std::vector<int> thirds;
    for (const uint32_t code : codes(packed))
        for (int c = kCellsPerFloat - 1; c >= 0; --c)
            thirds.push_back(int(code >> (2 * c) & 3));
    return thirds;
}

} // namespace

TEST(DirectionGrid, AColumnIsASixteenthOfTheLongitude)
{
    std::mt19937 random(1);
    for (int i = 0; i < 100000; ++i) {
        const V3f w = random_direction(random);
        const double s = latlong::position(V3d(w)).x * kColumns;
        if (std::abs(s - std::round(s)) > 1e-5) {
            ASSERT_EQ(column_of(w.x, w.z), int(s)) << w.x << " " << w.z;
        }
    }
    for (int c = 0; c < kColumns; ++c) {
        const V3d middle = column_middle(c);
        EXPECT_EQ(column_of(float(middle.x), float(middle.z)), c);
    }
    // The quarters' own axes begin a column each, from wherever zeros' signs point.
    for (const float zero : { 0.0f, -0.0f }) {
        EXPECT_EQ(column_of(zero, -1), 0);
        EXPECT_EQ(column_of(1, zero), 4);
        EXPECT_EQ(column_of(zero, 1), 8);
        EXPECT_EQ(column_of(-1, zero), 12);
        EXPECT_EQ(column_of(zero, zero), 0);
    }
}

TEST(DirectionGrid, SlicesHoldEverythingThatRoundingLeaves)
{
    EXPECT_EQ(slice_of(-1), 0);
    EXPECT_EQ(slice_of(1), kSlices - 1);
    EXPECT_EQ(slice_of(-1.0001f), 0);
    EXPECT_EQ(slice_of(1.0001f), kSlices - 1);
    for (int s = 0; s < kSlices; ++s)
        EXPECT_EQ(slice_of(float(0.5 * (edge(s) + edge(s + 1)))), s);
}

TEST(DirectionGrid, MomentsAreThoseOfTheirCells)
{
    const RunningMoments& moments = running_moments();
    V3d all(0);
    for (int c = 0; c < kColumns; ++c) {
        EXPECT_EQ(moments[size_t(c)][0], V3d(0));
        all += moments[size_t(c)][kSlices];
    }
    EXPECT_LT(all.length(), 1e-13);
    for (const auto [column, low, high] :
         { std::array { 3, 10, 12 }, std::array { 12, 0, 63 }, std::array { 8, 62, 63 } }) {
        V3d sum(0);
        const int steps = 400;
        for (int i = 0; i < steps; ++i)
            for (int j = 0; j < steps; ++j) {
                const double y = edge(low) + (edge(high) - edge(low)) * (i + 0.5) / steps;
                const V3d across = latlong::direction((column + (j + 0.5) / steps) / kColumns, 0.5);
                sum += V3d(across.x * std::sqrt(1 - y * y), y, across.z * std::sqrt(1 - y * y));
            }
        sum *= (edge(high) - edge(low)) * 2 * latlong::pi / kColumns / (double(steps) * steps);
        const V3d cell = moments[size_t(column)][size_t(high)] - moments[size_t(column)][size_t(low)];
        EXPECT_LT((cell - sum).length(), 1e-4 * sum.length()) << column;
    }
}

TEST(PackedVisibility, EveryColumnKeepsItsBits)
{
    std::mt19937 random(2);
    for (int repeat = 0; repeat < 200; ++repeat) {
        std::array<MaskColumn, kColumns> columns;
        for (MaskColumn& view : columns)
            view = { int(random() % 64), int(random() % 64), int(random() % 16) };
        if (repeat == 0)
            columns.fill({ 63, 63, 15 });
        std::vector<float> packed(kMaskFloats);
        pack_mask(packed.data(), columns.data());
        const std::vector<uint32_t> whole = codes(packed);
        for (int c = 0; c < kColumns; ++c) {
            const MaskColumn back = unpack_mask(whole.data(), c), view = columns[size_t(c)];
            EXPECT_TRUE(back.low == view.low && back.high == view.high && back.density == view.density) << c;
        }
    }
}

TEST(PackedVisibility, AnOpenPointSeesEachColumnDownToTheHorizon)
{
    for (const V3f& normal : { V3f(0, 1, 0), V3f(0, -1, 0), V3f(1, 0, 0), V3f(0.48f, 0.6f, 0.64f) }) {
        const auto columns = mask_of(normal, 1024, [](const V3f&) { return true; });
        for (int c = 0; c < kColumns; ++c) {
            const V3d middle = column_middle(c);
            const MaskColumn view = columns[size_t(c)];
            for (int s = 0; s < kSlices; ++s) {
                const double y = 0.5 * (edge(s) + edge(s + 1)), across = std::sqrt(1 - y * y);
                const double cosine = V3d(normal).dot(V3d(middle.x * across, y, middle.z * across));
                if (std::abs(cosine) > 0.25) { // the horizon crosses a column over a third of its width
                    EXPECT_EQ(s >= view.low && s < view.high && view.density > 0, cosine > 0)
                        << normal.x << " column " << c << " slice " << s;
                }
            }
        }
    }
}

TEST(PackedVisibility, AWallShutsTheColumnsBehindIt)
{
    const auto open = [](const V3f& w) { return w.x > 0; };
    const auto columns = mask_of(V3f(0, 1, 0), 512, open);
    for (int c = 0; c < kColumns; ++c) // x > 0 is the first half of the longitude
        EXPECT_EQ(columns[size_t(c)].density > 0, c < 8) << c;
    const std::vector<int> thirds = cells_of(V3f(0, 1, 0), 2048, open);
    for (int cell = 0; cell < kCells; ++cell) {
        const int band = cell / kColumns;
        EXPECT_EQ(thirds[size_t(cell)],
                  band > kBands / 2 && cell % kColumns < 8 ? 3
                      : band == kBands / 2                 ? thirds[size_t(cell)]
                                                           : 0)
            << cell;
    }
}

TEST(PackedVisibility, ALidLeavesTheSlicesBelowIt)
{
    const auto columns = mask_of(V3f(0, 1, 0), 4096, [](const V3f& w) { return w.y < 0.5f; });
    for (const MaskColumn& view : columns) {
        EXPECT_NEAR(edge(view.low), 0, 0.04);
        EXPECT_NEAR(edge(view.high), 0.5, 0.04);
        EXPECT_GE(view.density, 13);
    }
}

TEST(PackedVisibility, DensityIsTheShareOfTheIntervalThatIsSeen)
{
    // Every second of very thin slices: a blind.
    const auto blind = [](const V3f& w) { return int(w.y * 4096) % 2 == 0; };
    for (const MaskColumn& view : mask_of(V3f(0, 1, 0), 4096, blind))
        EXPECT_NEAR(view.density, 7.5, 1.6);
    const std::vector<int> thirds = cells_of(V3f(0, 1, 0), 4096, blind);
    const int best = *std::max_element(thirds.begin(), thirds.end());
    EXPECT_EQ(best, 3); // of the cell that is seen best
    // Half of the zenith is seen, between one and two thirds of that.
    EXPECT_NEAR(thirds[8 * kColumns + 3], 1.5, 0.5);
}

TEST(PackedVisibility, NothingSeenIsNothingStored)
{
    for (const MaskColumn& view : mask_of(V3f(0, 1, 0), 256, [](const V3f&) { return false; }))
        EXPECT_EQ(view.density + view.low + view.high, 0);
    for (const int third : cells_of(V3f(0, 1, 0), 256, [](const V3f&) { return false; }))
        EXPECT_EQ(third, 0);
}

TEST(PackedVisibility, WhereNoRayWentAsMuchIsSeenAsOfTheWhole)
{
    // Five rays, of which four go up: no column or cell that none went to is shut, and none below the horizon is open.
    const auto open = [] { return [rays = 0](const V3f&) mutable { return ++rays != 4; }; };
    const V3f normal(0, 1, 0);
    for (const MaskColumn& view : mask_of(normal, 5, open())) {
        EXPECT_GE(edge(view.low), view.density ? -0.04 : -1);
        EXPECT_TRUE(view.density == 0 || view.high > view.low);
    }
    int unasked = 0;
    for (const MaskColumn& view : mask_of(normal, 5, open()))
        unasked += view.density == 12 && view.high == kSlices; // four fifths of fifteen
    EXPECT_GE(unasked, kColumns - 5);
    const std::vector<int> thirds = cells_of(normal, 5, open());
    for (int cell = 0; cell < kCells; ++cell) {
        if (cell / kColumns < kBands / 2) {
            EXPECT_EQ(thirds[size_t(cell)], 0);
        }
    }
    int like_the_whole = 0;
    for (int column = 0; column < kColumns; ++column) {
        const int top = thirds[size_t((kBands - 1) * kColumns + column)];
        for (int band = kBands / 2 + 1; band < kBands; ++band)
            EXPECT_EQ(thirds[size_t(band * kColumns + column)], top); // of the only ray, or of all
        like_the_whole += top == 2;
    }
    EXPECT_GE(like_the_whole, kColumns - 5);
}
