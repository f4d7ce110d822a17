// SPDX-License-Identifier: Apache-2.0
#include "lightmap_scene.h"

#include <OpenImageIO/imagebufalgo.h>

#include <algorithm>
#include <array>
#include <cstdio>

using namespace vmlight;
using namespace scene;
using OIIO::ImageBufAlgo::channels;

namespace {

const ImageBuf kVismap = random_vismap(30, 20), kCfem = random_cfem(16, 8);

} // namespace

TEST(LightmapInput, ChannelsAreFoundByNameInAnyOrder)
{
    const ImageBuf expected = lit(kVismap, kCfem);
    std::array<int, 4> order { 0, 1, 2, 3 };
    do {
        EXPECT_TRUE(same_bits(lit(channels(kVismap, 4, order), kCfem), expected)) << order[0] << order[1] << order[2];
    } while (std::next_permutation(order.begin(), order.end()));

    const std::array<int, 6> wider { 3, -1, 0, 2, -1, 1 };
    const std::array<std::string, 6> names { "direction.z", "coverage", "visibility",
                                             "direction.y", "samples",  "direction.x" };
    EXPECT_TRUE(same_bits(lit(channels(kVismap, 6, wider, {}, names), kCfem), expected));
    const std::array<int, 4> bgra { 2, 1, 0, -1 };
    const std::array<std::string, 4> bgra_names { "B", "G", "R", "A" };
    EXPECT_TRUE(same_bits(lit(kVismap, channels(kCfem, 4, bgra, {}, bgra_names)), expected));
}

TEST(LightmapInput, HalfIsReadAsTheFloatsItStandsFor)
{
    ImageBuf half, back;
    half.copy(kVismap, OIIO::TypeHalf);
    back.copy(half, OIIO::TypeFloat);
    EXPECT_TRUE(same_bits(lit(half, kCfem), lit(back, kCfem)));
    // On a smooth environment half costs what it rounds off V and B: 2^-11, twice.
    const ImageBuf smooth = cfem(64, 32, [](V3d n) { return V3f(float(1 + 0.5 * n.y)); });
    EXPECT_LT(difference(lit(half, smooth), lit(kVismap, smooth)), 1e-3f);
}

TEST(LightmapInput, AFileIsAsGoodAsMemory)
{
    const std::string path = testing::TempDir() + "lightmap_input_test.exr";
    ASSERT_TRUE(kVismap.write(path)) << kVismap.geterror();
    EXPECT_TRUE(same_bits(lit(ImageBuf(path), kCfem), lit(kVismap, kCfem)));
    std::remove(path.c_str());
}

TEST(LightmapInput, ThreadsDoNotChangeABit)
{
    const ImageBuf vm = random_vismap(300, 200), albedo = random_cfem(300, 200);
    const ImageBuf one = lit(vm, kCfem, {}, &albedo, 1);
    for (int threads : { 0, 2, 7 })
        EXPECT_TRUE(same_bits(lit(vm, kCfem, {}, &albedo, threads), one)) << threads;
}

TEST(LightmapInput, AlbedoMultiplies)
{
    const ImageBuf plain = lit(kVismap, kCfem), albedo = random_cfem(30, 20), image = lit(kVismap, kCfem, {}, &albedo);
    for (int i = 0; i < 3 * 600; ++i)
        ASSERT_EQ(pixels(image)[i], pixels(plain)[i] * pixels(albedo)[i]);

    ImageBuf gray(ImageSpec(30, 20, 1, OIIO::TypeFloat));
    std::fill_n(pixels(gray), 600, 0.25f);
    const ImageBuf dim = lit(kVismap, kCfem, {}, &gray);
    for (int i = 0; i < 3 * 600; ++i)
        ASSERT_EQ(pixels(dim)[i], pixels(plain)[i] * 0.25f);
}

// A crop of 30x20 out of 60x40, and of 30x20 beside its stored pixels.
TEST(LightmapInput, AlbedosDisplayWindowIsTheTexture)
{
    const ImageBuf plain = lit(kVismap, kCfem);
    ImageSpec spec(30, 20, 1, OIIO::TypeFloat);
    spec.full_width = 60;
    spec.full_height = 40;
    ImageBuf quarter(spec);
    OIIO::ImageBufAlgo::fill(quarter, { 1.0f });
    const ImageBuf cropped = lit(kVismap, kCfem, {}, &quarter);
    for (int y : { 0, 8, 11, 19 }) // not at the filter's edge
        for (int x : { 0, 13, 16, 29 })
            EXPECT_NEAR(color(cropped, x, y).x, x < 15 && y < 10 ? color(plain, x, y).x : 0, 1e-6);

    spec.full_width = 30;
    spec.full_height = 20;
    spec.x = 10;
    ImageBuf right(spec);
    OIIO::ImageBufAlgo::fill(right, { 1.0f });
    const ImageBuf moved = lit(kVismap, kCfem, {}, &right);
    for (int x = 0; x < 30; ++x)
        ASSERT_EQ(color(moved, x, 7).x, x < 10 ? 0 : color(plain, x, 7).x);
}

TEST(LightmapInput, AlbedoOfAnotherSizeIsResizedWithoutRinging)
{
    const ImageBuf white = cfem(4, 2, [](V3d) { return V3f(1); });
    const ImageBuf open = vismap(12, 12, [](int, int) { return VismapTexel { 1, V3f(0, 1, 0) }; });
    // Black on the left, white on the right, in 8 bits: a filter with negative lobes would leave [0, 1] at the edge.
    for (int side : { 4, 36 }) {
        ImageBuf albedo(ImageSpec(side, side, 3, OIIO::TypeUInt8));
        const float one[3] { 1, 1, 1 };
        for (int y = 0; y < side; ++y)
            for (int x = side / 2; x < side; ++x)
                albedo.setpixel(x, y, one, 3);
        const ImageBuf image = lit(open, white, {}, &albedo);
        for (int x = 0; x < 12; ++x) {
            EXPECT_GE(color(image, x, 5).x, x ? color(image, x - 1, 5).x : 0) << side;
            EXPECT_LE(color(image, x, 5).x, 1 + 1e-6f) << side;
        }
        EXPECT_NEAR(color(image, 0, 5).x, 0, 1e-6) << side;
        EXPECT_NEAR(color(image, 11, 5).x, 1, 1e-6) << side;
    }
}

TEST(LightmapInput, TheResultSaysHowItWasMade)
{
    ImageBuf vm = random_vismap(30, 20), map = random_cfem(16, 8);
    vm.specmod().attribute("vmlight:stage", "vismap");
    vm.specmod().attribute("vmlight:mesh", "hero.obj");
    vm.specmod().attribute("vmlight:meshHash", "0123");
    vm.specmod().attribute("vmlight:samples", "128");
    vm.specmod().attribute("colorInteropID", "data");
    map.specmod().attribute("vmlight:stage", "cfem");
    map.specmod().attribute("colorInteropID", "lin_rec709_scene");
    const float primaries[8] { 0.64f, 0.33f, 0.3f, 0.6f, 0.15f, 0.06f, 0.3127f, 0.329f };
    map.specmod().attribute("chromaticities", OIIO::TypeDesc(OIIO::TypeDesc::FLOAT, 8), primaries);
    LightmapParams params;
    params.rotate = { 0, 45, 0 };
    const ImageBuf image = lit(vm, map, params);
    const ImageSpec& spec = image.spec();
    EXPECT_EQ(spec.get_string_attribute("vmlight:stage"), "lightmap");
    EXPECT_NE(spec.get_string_attribute("vmlight:version"), "");
    EXPECT_EQ(spec.get_string_attribute("vmlight:rotate"), "0,45,0");
    EXPECT_EQ(spec.get_string_attribute("vmlight:model"), "paper");
    EXPECT_EQ(spec.get_string_attribute("vmlight:mesh"), "hero.obj");
    EXPECT_EQ(spec.get_string_attribute("vmlight:meshHash"), "0123");
    EXPECT_EQ(spec.get_string_attribute("colorInteropID"), "lin_rec709_scene");
    const OIIO::ParamValue* chromaticities = spec.find_attribute("chromaticities");
    ASSERT_NE(chromaticities, nullptr);
    EXPECT_EQ(chromaticities->type(), OIIO::TypeDesc(OIIO::TypeDesc::FLOAT, 8));
    EXPECT_EQ(spec.find_attribute("vmlight:samples"), nullptr);
    EXPECT_EQ(spec.find_attribute("oiio:ColorSpace"), nullptr);
}

TEST(LightmapInput, AResultMayReplaceAnInputOrAnEarlierResult)
{
    const ImageBuf expected = lit(kVismap, kCfem);
    ImageBuf dst = kVismap;
    ASSERT_TRUE(make_lightmap(dst, dst, kCfem)) << dst.geterror();
    EXPECT_TRUE(same_bits(dst, expected));

    ImageBuf albedo = random_cfem(30, 20);
    const ImageBuf tinted = lit(kVismap, kCfem, {}, &albedo);
    ASSERT_TRUE(make_lightmap(albedo, kVismap, kCfem, {}, &albedo)) << albedo.geterror();
    EXPECT_TRUE(same_bits(albedo, tinted));

    // In a turntable the memory stays and the metadata does not.
    const void* memory = dst.localpixels();
    dst.specmod().attribute("stale", 1);
    ASSERT_TRUE(make_lightmap(dst, kVismap, kCfem)) << dst.geterror();
    EXPECT_TRUE(same_bits(dst, expected));
    EXPECT_EQ(dst.localpixels(), memory);
    EXPECT_EQ(dst.spec().find_attribute("stale"), nullptr);
}
