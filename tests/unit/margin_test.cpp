// SPDX-License-Identifier: Apache-2.0
#include <vmlight/uv/margin.h>

#include <Imath/ImathVec.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

using namespace vmlight;
using Imath::V3f;

namespace {

struct Image
{
    Image(int w, int h, int channel_count = 4)
        : width(w)
        , height(h)
        , channels(channel_count)
        , pixels(size_t(w) * h * channel_count, -7.0f) // no margin may leak this
        , coverage(w, h)
    {
    }
    float* at(int x, int y) { return pixels.data() + (size_t(y) * width + x) * channels; }
    void cover(int x, int y, std::array<float, 4> value)
    {
        coverage.set(x, y);
        std::copy(value.begin(), value.end(), at(x, y));
    }
    void fill(int rings) { fill_margin(pixels.data(), channels, coverage, rings); }

    int width, height, channels;
    std::vector<float> pixels;
    Coverage coverage;
};

// Chebyshev distance to the nearest covered texel.
int distance_to(const std::vector<std::array<int, 2>>& covered, int x, int y)
{
    int least = 1 << 20;
    for (const auto& [cx, cy] : covered)
        least = std::min(least, std::max(std::abs(cx - x), std::abs(cy - y)));
    return least;
}

std::vector<std::array<int, 2>> cover_at_random(Image& image, int count, unsigned seed)
{
    std::mt19937 random(seed);
    std::uniform_real_distribution<float> in(-1, 1);
    std::vector<std::array<int, 2>> covered;
    for (int i = 0; i < count; ++i) {
        const int x = int(random() % image.width), y = int(random() % image.height);
        std::array<float, 4> value { 0.5f + 0.5f * std::abs(in(random)), in(random), in(random), in(random) };
        const float length = std::sqrt(value[1] * value[1] + value[2] * value[2] + value[3] * value[3]);
        for (int c = 1; c < 4; ++c)
            value[c] *= value[0] / length;
        image.cover(x, y, value);
        covered.push_back({ x, y });
    }
    return covered;
}

} // namespace

TEST(Margin, OpposedDirectionsDoNotCancelWhereTwoMarginsMeet)
{
    for (int gap : { 1, 2, 3, 4 }) {
        Image image(gap + 2, 3);
        for (int y = 0; y < 3; ++y) {
            image.cover(0, y, { 1, 0.6f, 0, 0 });
            image.cover(gap + 1, y, { 1, -0.5f, 0.1f, 0 });
        }
        image.fill(-1);
        for (int y = 0; y < 3; ++y)
            for (int x = 0; x < gap + 2; ++x) {
                const float* texel = image.at(x, y);
                EXPECT_EQ(texel[0], 1) << gap << ": " << x << "," << y;
                EXPECT_GE(std::hypot(texel[1], texel[2]), 0.5f) << gap << ": " << x << "," << y;
            }
    }
}

TEST(Margin, WhereTwoMarginsMeetEachTexelLooksAsOneOfThemDoes)
{
    // 35 degrees apart: half way between them another light might be.
    const V3f left(0.6f, 0, 0), right(0.6f * std::cos(0.61f), 0.6f * std::sin(0.61f), 0);
    for (int gap = 1; gap < 12; ++gap) {
        Image image(gap + 2, 5);
        for (int y = 0; y < 5; ++y) {
            image.cover(0, y, { 1, left.x, left.y, left.z });
            image.cover(gap + 1, y, { 1, right.x, right.y, right.z });
        }
        image.fill(-1);
        for (int y = 0; y < 5; ++y)
            for (int x = 0; x < gap + 2; ++x) {
                const float* texel = image.at(x, y);
                const V3f direction(texel[1], texel[2], texel[3]);
                EXPECT_LT(std::min((direction - left).length(), (direction - right).length()), 1e-6f)
                    << gap << ": " << x << "," << y;
            }
    }
}

TEST(Margin, EveryRingIsOneTexelWide)
{
    for (const auto& [width, height] : { std::pair(40, 30), { 63, 5 }, { 64, 64 }, { 65, 3 }, { 200, 33 }, { 1, 70 } })
        for (int rings : { 0, 1, 2, 5, 16 }) {
            Image image(width, height);
            const auto covered = cover_at_random(image, 6, unsigned(width + rings));
            const std::vector<float> before = image.pixels;
            image.fill(rings);
            for (int y = 0; y < height; ++y)
                for (int x = 0; x < width; ++x) {
                    const int distance = distance_to(covered, x, y);
                    EXPECT_EQ(image.coverage.get(x, y), distance <= rings) << x << "," << y;
                    EXPECT_EQ(image.at(x, y)[0] == -7.0f, distance > rings) << x << "," << y;
                    for (int c = 0; c < 4 && (distance == 0 || distance > rings); ++c)
                        EXPECT_EQ(image.at(x, y)[c], before[(size_t(y) * width + x) * 4 + c]);
                }
        }
}

TEST(Margin, AnInfiniteMarginFillsAll)
{
    Image image(150, 70);
    image.cover(149, 69, { 0.5f, 0.1f, 0.2f, 0.3f });
    image.fill(-1);
    for (int y = 0; y < 70; ++y)
        for (int x = 0; x < 150; ++x) {
            ASSERT_TRUE(image.coverage.get(x, y));
            EXPECT_EQ(image.at(x, y)[0], 0.5f);
            EXPECT_EQ(image.at(x, y)[3], 0.3f);
        }
}

TEST(Margin, WithNothingCoveredNothingChanges)
{
    for (int rings : { 3, -1 }) {
        Image image(70, 9);
        image.fill(rings);
        for (float value : image.pixels)
            EXPECT_EQ(value, -7.0f);
        EXPECT_FALSE(image.coverage.get(0, 0));
    }
}

TEST(Margin, AFilledTexelIsTheMeanOfItsFilledNeighbours)
{
    Image image(5, 3);
    image.cover(0, 1, { 1, 0, 0, 0.5f });
    image.cover(2, 1, { 0, 0.125f, 0, 0.375f });
    image.fill(2);
    EXPECT_EQ(image.at(1, 0)[0], 0.5f); // between the two
    EXPECT_EQ(image.at(1, 0)[1], 0.0625f);
    EXPECT_EQ(image.at(1, 0)[3], 0.4375f);
    EXPECT_EQ(image.at(0, 0)[0], 1); // the right one is two texels away
    EXPECT_EQ(image.at(3, 2)[0], 0);
    EXPECT_EQ(image.at(4, 1)[1], 0.125f); // second ring: of the three of the first
}

TEST(Margin, FilledValuesStayAmongTheCoveredOnes)
{
    for (unsigned seed = 0; seed < 5; ++seed) {
        Image image(64, 64);
        cover_at_random(image, 20, seed);
        float low[4] = { 9, 9, 9, 9 }, high[4] = { -9, -9, -9, -9 };
        for (int y = 0; y < 64; ++y)
            for (int x = 0; x < 64; ++x)
                for (int c = 0; c < 4 && image.coverage.get(x, y); ++c) {
                    low[c] = std::min(low[c], image.at(x, y)[c]);
                    high[c] = std::max(high[c], image.at(x, y)[c]);
                }
        image.fill(-1);
        for (int y = 0; y < 64; ++y)
            for (int x = 0; x < 64; ++x) {
                const float* p = image.at(x, y);
                for (int c = 0; c < 4; ++c) {
                    EXPECT_GE(p[c], low[c]);
                    EXPECT_LE(p[c], high[c]);
                }
                EXPECT_LE(std::sqrt(p[1] * p[1] + p[2] * p[2] + p[3] * p[3]), p[0] * (1 + 1e-6f));
            }
    }
}

TEST(Margin, FurtherChannelsMayBeFilledByTheSameNeighbours)
{
    Image image(9, 3, 6);
    image.cover(0, 1, { 1, 0, 0, 0.5f });
    image.cover(2, 1, { 1, 0, 0, -0.25f }); // looks away from the first
    for (int x : { 0, 2 })
        image.at(x, 1)[4] = float(x + 1);
    fill_margin(image.pixels.data(), 6, image.coverage, 1, { 5, 0 });
    EXPECT_EQ(image.at(1, 1)[3], 0.5f);
    EXPECT_EQ(image.at(1, 1)[4], 1);
    EXPECT_EQ(image.at(3, 1)[4], 3);
    EXPECT_EQ(image.at(1, 1)[5], -7);
}

TEST(Margin, FurtherChannelsAreLeftAlone)
{
    Image image(9, 9, 5);
    image.cover(4, 4, { 1, 0, 0, 0.5f });
    image.at(4, 4)[4] = 1;
    image.fill(3);
    EXPECT_EQ(image.at(4, 4)[4], 1);
    EXPECT_EQ(image.at(3, 4)[4], -7);
    EXPECT_EQ(image.at(3, 4)[3], 0.5f);
}

TEST(Margin, APlanFillsTheSameOnAnyNumberOfThreads)
{
    Image image(400, 300);
    cover_at_random(image, 40, 5);
    const Image empty = image;
    MarginPlan plan;
    fill_margin(image.pixels.data(), 4, image.coverage, 60, {}, &plan);
    int shared = 0; // rings of several parts
    for (size_t part = 1; part < plan.parts.size(); ++part)
        shared += plan.parts[part].ring == plan.parts[part - 1].ring;
    EXPECT_GT(shared, 10);
    EXPECT_EQ(plan.parts.back().ring, 59);
    for (const int threads : { 1, 4 }) {
        Image again = empty;
        plan.fill(again.pixels.data(), 4, threads);
        EXPECT_EQ(again.pixels, image.pixels) << threads;
    }
    // Appended to, it fills one after the other.
    Image first(64, 64), both(64, 64);
    MarginPlan twice;
    for (Image* each : { &first, &both })
        cover_at_random(*each, 3, 6);
    for (int ring = 0; ring < 2; ++ring)
        fill_margin(first.pixels.data(), 4, first.coverage, 1, {}, &twice);
    twice.fill(both.pixels.data(), 4, 4);
    EXPECT_EQ(both.pixels, first.pixels);
}
