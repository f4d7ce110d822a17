// SPDX-License-Identifier: Apache-2.0
// What frames look up: weighted pyramids, files through OIIO's texture system, and where pixels are sampled.
#include "scenes.h"
#include "temporary_folder.h"

#include <vmlight/frame/pixel_samples.h>
#include <vmlight/frame/surface_texture.h>
#include <vmlight/frame/texture_pyramid.h>

#include <OpenImageIO/imagebuf.h>
#include <OpenImageIO/imagebufalgo.h>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <random>
#include <set>

using namespace vmlight;
using Imath::V2d;

namespace {

std::vector<float> noise(size_t count)
{
    std::mt19937 random(1);
    std::vector<float> values(count);
    for (float& value : values)
        value = float(random() % 1000) / 500;
    return values;
}

TextureFootprint at(double s, double t, double reach = 0, int width = 1, int height = 1)
{
    return { V2d(s, t), V2d(reach / width, 0), V2d(0, reach / height) };
}

float value(const TexturePyramid& image, const TextureFootprint& where)
{
    float result = NAN;
    image.lookup(where, &result);
    return result;
}

} // namespace

TEST(TexturePyramid, TexelCentresAreTheTexels)
{
    const int width = 7, height = 5;
    const std::vector<float> pixels = noise(width * height);
    const TexturePyramid image(width, height, 1, pixels.data(), nullptr);
    for (int y = 0; y < height; ++y)
        for (int x = 0; x < width; ++x)
            for (const double reach : { 0.0, 0.5, 1.0 })
                EXPECT_FLOAT_EQ(value(image, at((x + 0.5) / width, (y + 0.5) / height, reach, width, height)),
                                pixels[size_t(y * width + x)]);
}

TEST(TexturePyramid, TheLastTexelIsTheMeanOfAnySize)
{
    for (const auto& [width, height] : { std::pair(8, 8), std::pair(7, 5), std::pair(1, 9), std::pair(100, 37) }) {
        const std::vector<float> pixels = noise(size_t(width) * size_t(height));
        const TexturePyramid image(width, height, 1, pixels.data(), nullptr);
        double mean = 0;
        for (const float pixel : pixels)
            mean += double(pixel) / double(pixels.size());
        EXPECT_EQ(image.levels().back().width * image.levels().back().height, 1);
        EXPECT_NEAR(image.levels().back().texels[0], mean, 2e-6) << width;
        EXPECT_NEAR(value(image, at(0.3, 0.8, 1e6, 1, 1)), mean, 2e-6) << width;
    }
}

// A map of islands: what lies between them is never seen, at whatever size.
TEST(TexturePyramid, AConstantWithHolesIsThatConstant)
{
    const int side = 64;
    const float constant = 3.7f;
    std::vector<float> pixels(side * side, 1e6f), weights(side * side, 0.0f);
    std::mt19937 random(2);
    for (int i = 0; i < side * side; ++i)
        if (random() % 4 == 0) {
            pixels[size_t(i)] = constant;
            weights[size_t(i)] = 1;
        }
    const TexturePyramid image(side, side, 1, pixels.data(), weights.data());
    for (int i = 0; i < 2000; ++i) {
        const double s = double(random() % 1000) / 1000, t = double(random() % 1000) / 1000;
        EXPECT_NEAR(value(image, at(s, t, std::exp2(i % 12 - 4), side, side)), constant, 1e-6 * double(constant));
    }
}

TEST(TexturePyramid, WithoutAnyWeightItIsBlack)
{
    const std::vector<float> pixels(16, 5.0f), weights(16, 0.0f);
    EXPECT_EQ(value(TexturePyramid(4, 4, 1, pixels.data(), weights.data()), at(0.4, 0.6, 2, 4, 4)), 0);
}

TEST(TexturePyramid, TheLevelIsThatOfTheFootprint)
{
    const std::vector<float> pixels = noise(64 * 32);
    const TexturePyramid image(64, 32, 1, pixels.data(), nullptr);
    EXPECT_EQ(image.level_of({ V2d(0), V2d(1.0 / 64, 0), V2d(0, 1.0 / 32) }), 0);
    EXPECT_DOUBLE_EQ(image.level_of({ V2d(0), V2d(4.0 / 64, 0), V2d(0, 1.0 / 32) }), 2);
    EXPECT_DOUBLE_EQ(image.level_of({ V2d(0), V2d(0, 0), V2d(0, 8.0 / 32) }), 3);
    EXPECT_DOUBLE_EQ(image.level_of({ V2d(0), V2d(3.0 / 64, 4.0 / 32), V2d(0) }), std::log2(5.0));
    EXPECT_EQ(image.level_of(at(0, 0)), 0);
}

TEST(TexturePyramid, WrapsAsItIsAsked)
{
    const std::array<float, 4> row { 1, 2, 3, 4 };
    const auto wrapped = [&](TextureWrap wrap, double s) {
        return value(TexturePyramid(4, 1, 1, row.data(), nullptr, wrap), at(s, 0.5));
    };
    EXPECT_EQ(wrapped(TextureWrap::clamp, -2.3), 1);
    EXPECT_EQ(wrapped(TextureWrap::clamp, 7), 4);
    EXPECT_EQ(wrapped(TextureWrap::periodic, 0.125 - 3), 1);
    EXPECT_EQ(wrapped(TextureWrap::periodic, 0), 2.5f); // between the last and the first
    EXPECT_EQ(wrapped(TextureWrap::periodic, 0.375 + 5), 2);
    EXPECT_EQ(wrapped(TextureWrap::mirror, -0.125), 1);
    EXPECT_EQ(wrapped(TextureWrap::mirror, 1.125), 4);
    EXPECT_EQ(wrapped(TextureWrap::mirror, 2.375), 2);
}

TEST(TileTexture, EachTileHasItsImage)
{
    TileTexture texture(1);
    for (const int udim : { 1001, 1002, 1011 }) {
        const float pixel = float(udim);
        texture.set(udim, TexturePyramid(1, 1, 1, &pixel, nullptr));
    }
    const auto look = [&](double u, double v) {
        float result = NAN;
        std::string error;
        EXPECT_TRUE(texture.lookup({ V2d(u, v) }, &result, error));
        return result;
    };
    EXPECT_EQ(look(0.5, 0.5), 1001);
    EXPECT_EQ(look(1.5, 0.5), 1002);
    EXPECT_EQ(look(0.5, 1.5), 1011);
    EXPECT_EQ(look(1, 0.5), 1001); // an island that ends on the border of its tile
    EXPECT_EQ(look(0, 0), 1001);
    EXPECT_EQ(look(2, 1), 1002);
    EXPECT_EQ(look(5.5, 0.5), 0);
    EXPECT_EQ(look(-0.5, 0.5), 0);
}

TEST(TileTexture, RowsAreFromTheTop)
{
    const std::array<float, 2> column { 1, 2 };
    TileTexture texture(1);
    texture.set(1001, TexturePyramid(1, 2, 1, column.data(), nullptr));
    float top = 0, bottom = 0;
    std::string error;
    texture.lookup({ V2d(0.5, 0.75) }, &top, error);
    texture.lookup({ V2d(0.5, 0.25) }, &bottom, error);
    EXPECT_EQ(top, 1);
    EXPECT_EQ(bottom, 2);
}

// A file whose sizes have each a colour of their own tells which one was read.
TEST(FileTexture, TakesTheMipThatTheDerivativesSay)
{
    const TemporaryFolder folder;
    const std::string path = folder / "mips.tif";
    const auto out = OIIO::ImageOutput::create("tiff");
    OIIO::ImageSpec spec(64, 64, 3, OIIO::TypeFloat);
    spec.tile_width = spec.tile_height = 64;
    spec.attribute("textureformat", "Plain Texture");
    int level = 0;
    for (int side = 64; side >= 1; side /= 2, ++level) {
        spec.width = spec.height = spec.full_width = spec.full_height = side;
        ASSERT_TRUE(out->open(path, spec, level ? OIIO::ImageOutput::AppendSubimage : OIIO::ImageOutput::Create));
        const std::vector<float> pixels(size_t(side * side * 3), float(level));
        ASSERT_TRUE(out->write_image(OIIO::TypeFloat, pixels.data()));
    }
    ASSERT_TRUE(out->close());
    FileTexture texture;
    std::string error;
    ASSERT_TRUE(texture.open(path, error)) << error;
    for (int step = 0; step <= 5; ++step) {
        const double reach = std::exp2(step) / 64;
        std::array<float, 3> rgb { NAN, NAN, NAN };
        ASSERT_TRUE(texture.lookup({ V2d(0.4, 0.3), V2d(reach, 0), V2d(0, reach) }, rgb.data(), error)) << error;
        EXPECT_NEAR(rgb[0], step, 0.02) << step;
        EXPECT_EQ(rgb[0], rgb[2]);
    }
}

TEST(FileTexture, GivesTheTexelsOfAPlainFile)
{
    const TemporaryFolder folder;
    OIIO::ImageBuf image(OIIO::ImageSpec(5, 4, 3, OIIO::TypeFloat));
    const std::vector<float> pixels = noise(5 * 4 * 3);
    image.set_pixels(image.roi(), OIIO::TypeFloat, pixels.data());
    ASSERT_TRUE(image.write(folder / "plain.exr"));
    FileTexture texture;
    std::string error;
    ASSERT_TRUE(texture.open(folder / "plain.exr", error)) << error;
    for (int y = 0; y < 4; ++y)
        for (int x = 0; x < 5; ++x) {
            std::array<float, 3> rgb {};
            ASSERT_TRUE(texture.lookup({ V2d((x + 0.5) / 5, 1 - (y + 0.5) / 4) }, rgb.data(), error)) << error;
            for (int c = 0; c < 3; ++c)
                EXPECT_NEAR(rgb[size_t(c)], pixels[size_t((y * 5 + x) * 3 + c)], 1e-5);
        }
}

TEST(FileTexture, TilesAreNotUpsideDown)
{
    const TemporaryFolder folder;
    for (const int udim : { 1001, 1012 }) {
        OIIO::ImageBuf image(OIIO::ImageSpec(1, 2, 3, OIIO::TypeFloat));
        for (int y = 0; y < 2; ++y) {
            const std::array<float, 3> pixel { float(udim), float(y), 0 };
            image.setpixel(0, y, pixel.data());
        }
        ASSERT_TRUE(image.write(folder / ("tile." + std::to_string(udim) + ".exr")));
    }
    FileTexture texture;
    std::string error;
    ASSERT_TRUE(texture.open(folder / "tile.<UDIM>.exr", error)) << error;
    const auto look = [&](double u, double v) {
        std::array<float, 3> rgb {};
        EXPECT_TRUE(texture.lookup({ V2d(u, v) }, rgb.data(), error)) << error;
        return rgb;
    };
    EXPECT_THAT(look(0.5, 0.75), testing::ElementsAre(1001, 0, 0)); // row 0 is the upper half
    EXPECT_THAT(look(0.5, 0.25), testing::ElementsAre(1001, 1, 0));
    EXPECT_THAT(look(1.5, 1.75), testing::ElementsAre(1012, 0, 0));
    EXPECT_THAT(look(1.5, 0.75), testing::ElementsAre(0, 0, 0)); // no file
}

TEST(FileTexture, WhatIsNoTextureIsRefused)
{
    const TemporaryFolder folder;
    FileTexture texture;
    std::string error;
    EXPECT_FALSE(texture.open(folder / "none.exr", error));
    EXPECT_THAT(error, testing::HasSubstr("none.exr"));
    EXPECT_FALSE(texture.open(folder / "none.<UDIM>.exr", error));
    EXPECT_THAT(error, testing::HasSubstr("no files match"));
    OIIO::ImageSpec spec(2, 2, 2, OIIO::TypeFloat);
    spec.channelnames = { "U", "V" };
    ASSERT_TRUE(OIIO::ImageBuf(spec).write(folder / "data.exr"));
    EXPECT_FALSE(texture.open(folder / "data.exr", error));
    EXPECT_THAT(error, testing::HasSubstr("data.exr"));
}

TEST(PixelSamples, AreSpreadEvenlyAlongBothAxes)
{
    for (const int count : { 1, 2, 3, 4, 7, 9, 16, 25, 64, 100 }) {
        const auto samples = pixel_samples(count, "box");
        std::set<int> columns, rows;
        double x = 0, y = 0;
        for (const PixelSample& sample : samples) {
            columns.insert(int(std::floor((sample.x + 0.5) * count)));
            rows.insert(int(std::floor((sample.y + 0.5) * count)));
            x += sample.x;
            y += sample.y;
            EXPECT_LT(std::max(std::abs(sample.x), std::abs(sample.y)), 0.5);
        }
        EXPECT_EQ(columns.size(), size_t(count));
        EXPECT_EQ(rows.size(), size_t(count));
        EXPECT_NEAR(x, 0, 1e-9 * count);
        EXPECT_NEAR(y, 0, 1e-9 * count);
    }
    EXPECT_EQ(pixel_samples(1, "blackman-harris")[0].x, 0);
    EXPECT_EQ(pixel_samples(1, "blackman-harris")[0].y, 0);
}

// The variance of each filter along an axis, in square pixels, by its formula.
TEST(PixelSamples, HaveTheShapeOfTheirFilter)
{
    const std::vector<std::pair<const char*, double>> variances {
        { "box", 1.0 / 12 }, { "triangle", 1.0 / 6 }, { "gaussian", 0.2434 }, { "blackman-harris", 0.1727 }
    };
    for (const auto& [filter, variance] : variances) {
        double sum = 0;
        const auto samples = pixel_samples(1024, filter);
        for (const PixelSample& sample : samples)
            sum += sample.y * sample.y;
        EXPECT_NEAR(sum / 1024, variance, 0.002) << filter;
        EXPECT_NEAR(filter_variance(filter), variance, 1e-4) << filter;
    }
    EXPECT_EQ(pixel_filter_choices().choices.size(), variances.size());
}
