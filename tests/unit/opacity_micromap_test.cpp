// SPDX-License-Identifier: Apache-2.0
// Micromaps against the textures that they stand for.
#include "cutout_scene.h"

#include <vmlight/trace/opacity_micromap.h>

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <set>

using namespace vmlight;
using namespace vmlight::cutout_scene;

namespace {

using UvCorners = std::array<V2f, 3>;

class Dice
{
public:
    explicit Dice(unsigned seed)
        : m_random(seed)
    {
    }
    double in(double low, double high) { return std::uniform_real_distribution<double>(low, high)(m_random); }
    int below(int n) { return int(m_random() % unsigned(n)); }
    TextureWrap wrap()
    {
        return std::array<TextureWrap, 3> { TextureWrap::clamp, TextureWrap::periodic,
                                            TextureWrap::mirror }[size_t(below(3))];
    }

private:
    std::mt19937 m_random;
};

// Noise, blobs and edges, so that there are cells of all kinds.
AlphaPointer random_texture(Dice& dice)
{
    const int width = 1 + dice.below(48), height = 1 + dice.below(48), kind = dice.below(4);
    const double a = dice.in(-1, 1), b = dice.in(-1, 1), c = dice.in(-10, 10);
    const auto alpha = [&](int x, int y) {
        const double along = a * x + b * y + c;
        return float(kind == 0       ? dice.in(0, 1)
                         : kind == 1 ? (std::fmod(std::abs(along), 16) < 8 ? 1 : 0)
                         : kind == 2 ? 0.5 + 0.5 * std::sin(along / 4)
                                     : (dice.below(40) ? 1 : 0));
    };
    return texture(width, height, alpha, dice.wrap(), dice.wrap(), dice.below(3) == 0);
}

UvCorners random_corners(Dice& dice)
{
    UvCorners uvs;
    const double size = std::array<double, 4> { 0.02, 0.5, 1, 4 }[size_t(dice.below(4))];
    const double away = dice.below(4) ? 0 : std::pow(10, dice.in(0, 7));
    for (V2f& uv : uvs)
        uv = V2f(float(away + dice.in(-size, size)), float(dice.in(-size, size)));
    if (dice.below(6) == 0)
        uvs[2] = uvs[1]; // a line
    if (dice.below(12) == 0)
        uvs[1] = uvs[2] = uvs[0]; // a point
    return uvs;
}

// What a map says of a point must be what the texture says. Returns whether the map knew.
bool agrees(const OpacityMicromap& map, const TriangleOpacity& triangle, double u, double v)
{
    const CellState state = map.whole != CellState::unknown ? map.whole : map.state(map.grid.cell(u, v));
    const double opacity = triangle.at(u, v);
    if (state == CellState::opaque) {
        EXPECT_EQ(opacity, 1) << u << " " << v;
    } else if (state == CellState::transparent) {
        EXPECT_EQ(opacity, 0) << u << " " << v;
    }
    return state != CellState::unknown;
}

void expect_agreement(const OpacityMicromap& map, const TriangleOpacity& triangle, Dice& dice, int points)
{
    const int n = 1 << map.grid.level;
    for (int i = 0; i < points; ++i) {
        double u = dice.in(0, 1), v = dice.in(0, 1);
        if (i % 4 == 0) { // on the borders of cells, where two must both be right
            u = double(dice.below(n + 1)) / n;
            v = i % 8 ? double(dice.below(n + 1)) / n : v;
            u = i % 3 ? u : std::nextafter(u, 0.0);
        }
        if (u + v > 1) {
            u = 1 - u;
            v = std::min(1 - v, 1 - u);
        }
        agrees(map, triangle, u, v);
    }
}

} // namespace

TEST(OpacityMicromap, EachCellHasANumberAndItsOwnPoints)
{
    for (int level = 0; level <= 5; ++level) {
        const MicromapGrid grid { level };
        const int n = 1 << level;
        std::set<int64_t> seen;
        for (int j = 0; j < n; ++j)
            for (int i = 0; i + j < n; ++i)
                for (bool upper : { false, true }) {
                    if (upper && i + j == n - 1)
                        continue;
                    const int64_t cell = grid.index(i, j, upper);
                    EXPECT_TRUE(seen.insert(cell).second);
                    EXPECT_LT(cell, grid.count());
                    const double middle = upper ? 2.0 / 3 : 1.0 / 3;
                    EXPECT_EQ(grid.cell((i + middle) / n, (j + middle) / n), cell);
                }
        EXPECT_EQ(int64_t(seen.size()), grid.count());
        for (const auto& [u, v] : { std::pair(0.0, 0.0), { 1.0, 0.0 }, { 0.0, 1.0 }, { 0.5, 0.5 }, { 0.25, 0.75 } })
            EXPECT_TRUE(seen.count(grid.cell(u, v))) << u << " " << v;
    }
}

TEST(OpacityMicromap, NoCellEverDisagreesWithItsTexture)
{
    for (unsigned seed = 0; seed < 1500; ++seed) {
        SCOPED_TRACE(testing::Message() << "seed " << seed);
        Dice dice(seed);
        MaterialOpacity rule = material(dice.below(3) ? AlphaMode::mask : AlphaMode::blend, random_texture(dice),
                                        dice.below(2) ? 1 : dice.in(0, 1), dice.below(5) ? dice.in(0, 1) : 0.5);
        if (dice.below(3) == 0)
            rule.textures[1].image = random_texture(dice);
        if (dice.below(3) == 0)
            rule.textures[0].uv_transform = Imath::M33d(dice.in(-2, 2), dice.in(-2, 2), 0, dice.in(-2, 2),
                                                        dice.in(-2, 2), 0, dice.in(-2, 2), dice.in(-2, 2), 1);
        const TriangleOpacity triangle(rule, { random_corners(dice), random_corners(dice) });
        const int level = std::min(micromap_level(triangle), 5);
        expect_agreement(make_micromap(triangle, level), triangle, dice, 300);
        expect_agreement(make_micromap(triangle, dice.below(4)), triangle, dice, 100);
        if (testing::Test::HasFailure())
            return;
    }
}

TEST(OpacityMicromap, OnlyCellsAtTheBorderAskTheTexture)
{
    const MaterialOpacity rule = material(AlphaMode::mask, leaf(256));
    const UvCorners uvs { V2f(0, 0), V2f(1, 0), V2f(0, 1) };
    const TriangleOpacity triangle(rule, { uvs, uvs });
    const OpacityMicromap map = make_micromap(triangle, micromap_level(triangle));
    EXPECT_GE(map.grid.level, 6);
    // One or two cells wide along a border as long as the triangle's longest side: 64 to 128 half squares of 4096 at
    // least, and 245 with its teeth.
    EXPECT_LT(double(map.unknown), 0.08 * double(map.grid.count()));
    EXPECT_GT(map.unknown, 0);
}

TEST(OpacityMicromap, WhatIsTheSameThroughoutHasNoCells)
{
    const UvCorners uvs { V2f(0, 0), V2f(1, 0), V2f(0, 1) };
    const auto made = [&](AlphaMode mode, const AlphaPointer& alpha, const UvCorners& corners) {
        const MaterialOpacity rule = material(mode, alpha);
        const TriangleOpacity triangle(rule, { corners, corners });
        return make_micromap(triangle, micromap_level(triangle));
    };
    const auto flat = [](float value) { return texture(64, 64, [value](int, int) { return value; }); };
    EXPECT_EQ(made(AlphaMode::mask, flat(0.5f), uvs).whole, CellState::opaque);
    EXPECT_EQ(made(AlphaMode::mask, flat(0.4f), uvs).whole, CellState::transparent);
    EXPECT_EQ(made(AlphaMode::blend, flat(1), uvs).whole, CellState::opaque);
    EXPECT_EQ(made(AlphaMode::blend, flat(0), uvs).whole, CellState::transparent);
    EXPECT_EQ(made(AlphaMode::blend, flat(0.5f), uvs).whole, CellState::unknown);
    // A point of a texture, between two texels of which the range says nothing.
    const AlphaPointer ramp = texture(2, 1, [](int x, int) { return float(x); });
    const UvCorners point { V2f(0.6f, 0.5f), V2f(0.6f, 0.5f), V2f(0.6f, 0.5f) };
    const OpacityMicromap at_point = made(AlphaMode::mask, ramp, point);
    EXPECT_EQ(at_point.whole, CellState::opaque);
    EXPECT_TRUE(at_point.cells.empty());
    // Cells that all say the same, though the box around the triangle says nothing: below the diagonal of the texture.
    const AlphaPointer below = texture(
        64, 64, [](int x, int y) { return x <= y + 2 ? 1.0f : 0.0f; }, TextureWrap::clamp, TextureWrap::clamp);
    EXPECT_EQ(made(AlphaMode::mask, below, { V2f(0, 0.9f), V2f(0, 0.1f), V2f(0.8f, 0.1f) }).whole, CellState::opaque);
}

TEST(OpacityMicromap, HostileTexturesAndUvsAreDefined)
{
    constexpr float kInf = std::numeric_limits<float>::infinity(), kMost = std::numeric_limits<float>::max();
    const std::vector<UvCorners> corners {
        { V2f(0, 0), V2f(1, 0), V2f(0, 1) },          { V2f(-1e6f, 3e7f), V2f(1e6f, 0), V2f(0, 1) },
        { V2f(1e20f, 0), V2f(1e20f, 0), V2f(0, 1) },  { V2f(kMost, kMost), V2f(-kMost, -kMost), V2f(kMost, -kMost) },
        { V2f(NAN, 0), V2f(1, 0), V2f(0, 1) },        { V2f(0, 0), V2f(kInf, 0), V2f(0, -kInf) },
        { V2f(1e-40f, 0), V2f(0, 0), V2f(0, 1e-40f) }
    };
    const std::vector<std::pair<int, int>> sizes { { 1, 1 }, { 1, 3000 }, { 3000, 1 }, { 7, 5 }, { 600, 600 } };
    Dice dice(5);
    for (const auto& [width, height] : sizes)
        for (TextureWrap wrap : { TextureWrap::clamp, TextureWrap::periodic, TextureWrap::mirror }) {
            const AlphaPointer alpha = texture(
                width, height, [&](int x, int y) { return (x / 3 + y / 3) % 2 ? 1.0f : 0.0f; }, wrap, wrap);
            for (const UvCorners& uvs : corners)
                for (AlphaMode mode : { AlphaMode::mask, AlphaMode::blend }) {
                    const MaterialOpacity rule = material(mode, alpha);
                    const TriangleOpacity triangle(rule, { uvs, uvs });
                    EXPECT_LE(micromap_level(triangle), MicromapGrid::kDeepest);
                    expect_agreement(make_micromap(triangle, std::min(micromap_level(triangle), 4)), triangle, dice,
                                     50);
                }
        }
}

TEST(OpacityMicromap, ACellWithinAnErrorIsThatOfEveryPointThere)
{
    Dice dice(5);
    int certain = 0;
    for (int i = 0; i < 200000; ++i) {
        const MicromapGrid grid { dice.below(MicromapGrid::kDeepest + 1) };
        const float error = float(std::pow(10, dice.in(-7, -1)));
        float u = float(dice.in(0, 1)), v = float(dice.in(0, 1)) * (1 - u);
        if (dice.below(2)) // close to lines of the grid
            u = std::round(u * float(1 << grid.level)) / float(1 << grid.level) + float(dice.in(-2, 2)) * error;
        const int64_t cell = grid.cell_within(u, v, error);
        if (cell < 0)
            continue;
        ++certain;
        for (const double du : { -1.0, 0.0, 1.0 })
            for (const double dv : { -1.0, 0.0, 1.0 })
                ASSERT_EQ(grid.cell(u + du * double(error), v + dv * double(error)), cell)
                    << u << " " << v << " +- " << error << " at level " << grid.level;
    }
    EXPECT_GT(certain, 50000);
    const float none = std::numeric_limits<float>::quiet_NaN(), infinite = std::numeric_limits<float>::infinity();
    const MicromapGrid grid { 4 };
    EXPECT_EQ(grid.cell_within(none, 0.3f, 1e-6f), -1);
    EXPECT_EQ(grid.cell_within(0.3f, none, 1e-6f), -1);
    EXPECT_EQ(grid.cell_within(0.33f, 0.3f, none), -1);
    EXPECT_EQ(grid.cell_within(0.33f, 0.3f, infinite), -1);
    EXPECT_EQ(grid.cell_within(1, 0, 1e-6f), -1);
    EXPECT_EQ(grid.cell_within(-1e-7f, 0.3f, 1e-6f), -1);
}
