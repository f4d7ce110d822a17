// SPDX-License-Identifier: Apache-2.0
#include "cfem_maps.h"

#include <vmlight/base/format.h>

#include <OpenImageIO/filesystem.h>

#include <gtest/gtest.h>

#include <cstring>

using namespace cfem_maps;

// What an environment may be.

TEST(Cfem, BorderSamplesReachHalfWayToTheirNeighbours)
{
    // Five samples at s = 0, 1/4, .. 1 and three at t = 0, 1/2, 1 are eight columns and four rows.
    const Map samples = random_map(5, 3, 11);
    Map cells(8, 4);
    const int column[8] = { 0, 1, 1, 2, 2, 3, 3, 4 }, row[4] = { 0, 1, 1, 2 };
    for (int y = 0; y < 4; ++y)
        for (int x = 0; x < 8; ++x)
            std::copy_n(samples.at(column[x], row[y]), 3, cells.at(x, y));
    OIIO::ImageBuf env = image(samples);
    env.specmod().attribute("oiio:sampleborder", 1);
    EXPECT_LT(largest_difference(filtered(env, exact(10, 5)), filtered(cells, 10, 5)), 1e-5);
    EXPECT_LT(largest_difference(filtered(env, harmonics(3, 10, 5)), filtered(image(cells), harmonics(3, 10, 5))),
              1e-6);
    OIIO::ImageBuf one = image(Map(1, 1, 2));
    one.specmod().attribute("oiio:sampleborder", 1);
    EXPECT_EQ(filtered(one, exact(2, 1)).rgb, Map(2, 1, 2).rgb);
}

TEST(Cfem, OneChannelServesAsAllThreeAndOthersAreIgnored)
{
    const Map map = random_map(12, 6, 5);
    OIIO::ImageSpec spec(12, 6, 5, OIIO::TypeFloat);
    spec.channelnames = { "A", "B", "G", "R", "Z" };
    OIIO::ImageBuf five(spec), gray(OIIO::ImageSpec(12, 6, 1, OIIO::TypeFloat));
    Map gray_map = map;
    for (int y = 0; y < 6; ++y)
        for (int x = 0; x < 12; ++x) {
            const float* rgb = map.at(x, y);
            const float all[5] = { NAN, rgb[2], rgb[1], rgb[0], -1 };
            five.setpixel(x, y, all);
            gray.setpixel(x, y, rgb);
            std::fill_n(gray_map.at(x, y), 3, rgb[0]);
        }
    EXPECT_EQ(filtered(five, exact(8, 4)).rgb, filtered(map, 8, 4).rgb);
    EXPECT_EQ(filtered(gray, exact(8, 4)).rgb, filtered(gray_map, 8, 4).rgb);
}

TEST(Cfem, CroppedMapIsBlackOutsideItsPixels)
{
    Map map = random_map(16, 8, 6);
    OIIO::ImageSpec spec(16, 3, 3, OIIO::TypeFloat);
    spec.y = 2;
    spec.full_height = 8;
    OIIO::ImageBuf env(spec);
    env.set_pixels(env.roi(), OIIO::TypeFloat, map.at(0, 2));
    std::fill(map.rgb.begin(), map.rgb.begin() + 2 * 16 * 3, 0.0f);
    std::fill(map.rgb.begin() + 5 * 16 * 3, map.rgb.end(), 0.0f);
    EXPECT_EQ(filtered(env, exact(8, 4)).rgb, filtered(map, 8, 4).rgb);
}

TEST(Cfem, MapsAreReadFromFilesRowByRow)
{
    const std::string path = OIIO::Filesystem::temp_directory_path() + "/" + OIIO::Filesystem::unique_path() + ".exr";
    const Map map = random_map(70, 35, 8);
    ASSERT_TRUE(image(map).write(path));
    EXPECT_EQ(filtered(OIIO::ImageBuf(path), exact(8, 4)).rgb, filtered(map, 8, 4).rgb);
    OIIO::Filesystem::remove(path);
}

// What is refused, and what is mended.

TEST(Cfem, BadPixelsAreCountedAndRefused)
{
    Map map(64, 32, 1);
    map.at(31, 7)[1] = NAN;
    map.at(0, 8)[0] = INFINITY;
    map.at(1, 31)[2] = -0.25f;
    EXPECT_EQ(refusal(image(map)),
              "environment has 3 values that are NaN, infinite or negative, the first at pixel (31, 7) channel \"G\"; "
              "set sanitize to repair them");
    EXPECT_EQ(refusal(image(map), harmonics(3, 4, 2)), refusal(image(map)));
    Map one(4, 2, 1);
    one.at(3, 1)[0] = -1;
    EXPECT_EQ(refusal(image(one)),
              "environment has 1 value that is negative, at pixel (3, 1) channel \"R\"; set sanitize to repair it");
    one.at(3, 1)[0] = 1;
    one.at(0, 0)[2] = one.at(0, 1)[0] = NAN;
    EXPECT_EQ(refusal(image(one)),
              "environment has 2 values that are NaN or infinite, the first at pixel (0, 0) channel \"B\"; "
              "set sanitize to repair them");
}

TEST(Cfem, WrongImagesAndParametersAreRefused)
{
    OIIO::ImageSpec spec(4, 2, 2, OIIO::TypeFloat);
    spec.channelnames = { "Z", "A" };
    EXPECT_EQ(refusal(OIIO::ImageBuf(spec)),
              "environment: no channels R, G, B, and no Y of grey, among Z, A; if one of them is light, name it with "
              "oiiotool --ch NAME,NAME,NAME --chnames R,G,B");
    EXPECT_EQ(refusal(OIIO::ImageBuf()), "environment has no pixels");
    EXPECT_NE(refusal(OIIO::ImageBuf("no/such.exr")).find("no/such.exr"), std::string::npos);
    OIIO::ImageBuf vismap = image(Map(4, 2));
    vismap.specmod().attribute("vmlight:stage", "vismap");
    EXPECT_NE(refusal(vismap).find("a visibility map, not light"), std::string::npos);
    for (int side : { 0, 65537 }) {
        OIIO::ImageBuf cropped = image(Map(4, 2));
        cropped.specmod().full_height = side;
        EXPECT_EQ(refusal(cropped),
                  vmlight::format("environment: display window of 4x{} pixels: sides must be 1 to "
                                  "65536",
                                  side));
    }
    EXPECT_NE(refusal(image(Map(4, 2)), exact(0, 2)).find("resolution: "), std::string::npos);
    EXPECT_NE(refusal(image(Map(4, 2)), harmonics(65, 4, 2)).find("order: 65"), std::string::npos);
    CfemParams unknown;
    unknown.filter = "gauss";
    EXPECT_NE(refusal(image(Map(4, 2)), unknown).find("filter: \"gauss\""), std::string::npos);
}

TEST(Cfem, SanitizeMendsFromSoundNeighbours)
{
    Map bad = random_map(8, 4, 9), good = bad;
    const auto mean = [&](std::initializer_list<std::pair<int, int>> around, int k) {
        double sum = 0;
        for (const auto& p : around)
            sum += good.at(p.first, p.second)[k];
        return float(sum / double(around.size()));
    };
    bad.at(3, 2)[0] = NAN;
    good.at(3, 2)[0] = mean({ { 2, 1 }, { 3, 1 }, { 4, 1 }, { 2, 2 }, { 4, 2 }, { 2, 3 }, { 3, 3 }, { 4, 3 } }, 0);
    // Over the seam, in the top row, beside another bad pixel, which is not sound.
    bad.at(0, 0)[1] = INFINITY;
    bad.at(7, 0)[1] = -3;
    good.at(0, 0)[1] = mean({ { 1, 0 }, { 7, 1 }, { 0, 1 }, { 1, 1 } }, 1);
    good.at(7, 0)[1] = 0;
    CfemParams params = exact(8, 4);
    params.sanitize = true;
    EXPECT_EQ(filtered(image(bad), params).rgb, filtered(good, 8, 4).rgb);
    EXPECT_EQ(filtered(image(Map(3, 3, NAN)), params).rgb, Map(8, 4, 0).rgb);

    OIIO::ImageBuf dst;
    ASSERT_TRUE(make_cfem(dst, image(bad), params, 1));
    EXPECT_EQ(dst.spec().get_int_attribute("vmlight:sanitized"), 3);
    ASSERT_TRUE(make_cfem(dst, image(good), params, 1));
    EXPECT_EQ(dst.spec().find_attribute("vmlight:sanitized"), nullptr);
}

TEST(Cfem, ResultSaysWhatItIs)
{
    OIIO::ImageBuf env = image(Map(4, 2, 1)), dst;
    const float primaries[8] = { 0.64f, 0.33f, 0.3f, 0.6f, 0.15f, 0.06f, 0.3127f, 0.329f };
    env.specmod().attribute("colorInteropID", "lin_rec709_scene");
    env.specmod().attribute("chromaticities", OIIO::TypeDesc(OIIO::TypeDesc::FLOAT, 8), primaries);
    env.specmod().attribute("envmap", 1);
    ASSERT_TRUE(make_cfem(dst, env, exact(8, 4)));
    const OIIO::ImageSpec& spec = dst.spec();
    EXPECT_EQ(spec.format, OIIO::TypeFloat);
    EXPECT_EQ(spec.get_string_attribute("vmlight:stage"), "cfem");
    EXPECT_EQ(spec.get_string_attribute("vmlight:filter"), "exact");
    EXPECT_EQ(spec.get_string_attribute("vmlight:resolution"), "8x4");
    EXPECT_FALSE(spec.get_string_attribute("vmlight:version").empty());
    EXPECT_EQ(spec.get_string_attribute("oiio:updirection"), "y");
    EXPECT_EQ(spec.get_string_attribute("colorInteropID"), "lin_rec709_scene");
    const OIIO::ParamValue* chromaticities = spec.find_attribute("chromaticities");
    ASSERT_NE(chromaticities, nullptr);
    EXPECT_EQ(std::memcmp(chromaticities->data(), primaries, sizeof primaries), 0);
    EXPECT_EQ(spec.find_attribute("oiio:ColorSpace"), nullptr);
    EXPECT_EQ(spec.find_attribute("envmap"), nullptr);
}
