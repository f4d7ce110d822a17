// SPDX-License-Identifier: Apache-2.0
// Environments of any size and shape.
#include "hard_case.h"

#include "cfem_maps.h"
#include "lightmap_scene.h"
#include "temporary_folder.h"
#include "watchdog.h"

#include <vmlight/base/sanitizers.h>
#include <vmlight/stage/make_stage.h>

#include <OpenImageIO/filesystem.h>
#include <OpenImageIO/imagebufalgo.h>
#include <OpenImageIO/imageio.h>

#include <fstream>
#include <limits>

using namespace cfem_maps;

namespace {

// KiB, from the kernel's own account of this process; 0 where it keeps none.
long memory(const char* which)
{
    std::ifstream status("/proc/self/status");
    for (std::string word; status >> word;)
        if (word == which) {
            long kib = 0;
            status >> kib;
            return kib;
        }
    return 0;
}

void forget_peak_of_memory()
{
    std::ofstream("/proc/self/clear_refs") << "5";
}

#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
constexpr bool kMemoryIsOurs = false;
#else
constexpr bool kMemoryIsOurs = true;
#endif

} // namespace

TEST(Light, ConstantLightOfEverySize)
{
    HardCase row("Constant light in every size from 1x1 to 12x12, and in 2x1, 1xN, odd and portrait sizes");
    double naive = 0, ours = 0;
    for (int h = 1; h <= 12; ++h)
        for (int w = 1; w <= 12; ++w) {
            const Map cfem = filtered_anyway(Map(w, h, 0.3f), 5, 4);
            ours = std::max(ours, largest_error(cfem, [](const V3d&) { return V3d(0.3f); }) / 0x1p-25);
            // A texel is a point at its centre.
            const V3d n = center(1, 1, 5, 4);
            double sum = 0;
            for (int y = 0; y < h; ++y)
                for (int x = 0; x < w; ++x)
                    sum += brute::solid_angle(y, w, h) / pi * std::max(0.0, n.dot(center(x, y, w, h))) * 0.3;
            naive = std::max(naive, std::abs(sum / 0.3 - 1));
        }
    for (const auto& [w, h] : { std::pair { 1, 977 }, { 977, 1 }, { 61, 307 } })
        ours = std::max(ours,
                        largest_error(filtered_anyway(Map(w, h, 0.3f), 5, 4), [](const V3d&) { return V3d(0.3f); })
                            / 0x1p-25);
    EXPECT_GT(naive, 0.75);
    row.naive("texels as points: an error of 75 % and more; prefix sums of whole rows: .96 at 1x1 (measured)");
    EXPECT_LE(ours, 1);
    row.ours("the constant, to 1 ulp of float");
}

TEST(Light, MapsStoredFlippedOrTurned)
{
    HardCase row("A Radiance image stored bottom row first, or rightmost column first");
    const vmlight::TemporaryFolder folder;
    const std::string head = "#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n", dark(8 * 4, '\0');
    std::string bright;
    for (int x = 0; x < 8; ++x)
        bright += "\x80\x80\x80\x81";
    const auto ground = [](const OIIO::ImageBuf& cfem) {
        float rgb[3] = {};
        cfem.getpixel(0, cfem.spec().height - 1, 0, rgb, 3);
        return rgb[0];
    };
    CfemRecipe recipe;
    recipe.cfem_params.resolution = { 8, 4 };
    OIIO::ImageBuf cfem;
    recipe.environment = folder.write("upright.hdr", head + "-Y 4 +X 8\n" + bright + dark + dark + dark);
    ASSERT_TRUE(make_image(cfem, recipe, MakeOptions {})) << cfem.geterror();
    EXPECT_LT(ground(cfem), 0.1f);
    recipe.environment = folder.write("flipped.hdr", head + "+Y 4 +X 8\n" + dark + dark + dark + bright);
    OIIO::ImageBuf plain(recipe.environment), upside_down;
    plain.read(0, 0, true, OIIO::TypeFloat);
    plain.specmod().erase_attribute("Orientation");
    ASSERT_TRUE(make_cfem(upside_down, plain, recipe.cfem_params)) << upside_down.geterror();
    EXPECT_GT(ground(upside_down), 0.1f);
    row.naive("light from below");
    for (const char* order : { "+Y 4 +X 8\n", "-Y 4 -X 8\n", "+Y 4 -X 8\n" }) {
        recipe.environment = folder.write("flipped.hdr", head + order + dark + dark + dark + bright);
        EXPECT_FALSE(make_image(cfem, recipe, MakeOptions {}));
        EXPECT_NE(cfem.geterror().find("oiiotool --reorient"), std::string::npos);
    }
    OIIO::ImageBuf albedo = image(random_map(8, 8, 5)), lit;
    albedo.specmod().attribute("Orientation", 6);
    EXPECT_FALSE(make_lightmap(lit, scene::random_vismap(8, 8), scene::random_cfem(8, 4), {}, &albedo));
    EXPECT_NE(lit.geterror().find("oiiotool --reorient"), std::string::npos);
    OIIO::ImageBuf map = scene::random_vismap(8, 8), cfem_turned = scene::random_cfem(8, 4);
    map.specmod().attribute("Orientation", 3);
    EXPECT_FALSE(make_lightmap(lit, map, scene::random_cfem(8, 4)));
    EXPECT_NE(lit.geterror().find("(Orientation 3); fix it with oiiotool --reorient"), std::string::npos);
    cfem_turned.specmod().attribute("Orientation", 4);
    EXPECT_FALSE(make_lightmap(lit, scene::random_vismap(8, 8), cfem_turned));
    EXPECT_NE(lit.geterror().find("(Orientation 4); fix it with oiiotool --reorient"), std::string::npos);
    row.ours("refused, naming the command that reorients it; an albedo, a visibility map and a CFEM too");
}

TEST(Light, AFewPixelsInALargeWindow)
{
    HardCase row("A crop of 64x32 pixels in a display window of 65536x32768");
    row.naive("two billion black pixels are filtered: 2 minutes (measured)");
    OIIO::ImageSpec spec(64, 32, 3, OIIO::TypeFloat);
    spec.full_width = 65536;
    spec.full_height = 32768;
    EXPECT_EQ(refusal(OIIO::ImageBuf(spec)),
              "environment: display window of 65536x32768 pixels is almost empty: only 64x32 are stored");
    spec.full_width = 640;
    spec.full_height = 320;
    OIIO::ImageBuf cropped(spec);
    OIIO::ImageBufAlgo::fill(cropped, { 1.0f, 1.0f, 1.0f });
    OIIO::ImageBuf cfem;
    EXPECT_TRUE(make_cfem(cfem, cropped, exact(8, 4))) << cfem.geterror();
    row.ours("refused at once beyond 2^27 pixels; a crop of any reasonable window is black outside its pixels");
}

TEST(Light, MapsThatAreNotTwiceAsWideAsHigh)
{
    HardCase row("A cube map, or a square light probe, given as an environment");
    row.naive("wrong light, without a warning");
    OIIO::ImageBuf cube = image(random_map(24, 16, 3));
    cube.specmod().attribute("textureformat", "CubeFace Environment");
    EXPECT_EQ(refusal(cube), "environment is a cube map, not a lat-long map");
    const vmlight::TemporaryFolder folder;
    CfemRecipe recipe;
    recipe.cfem_params.resolution = { 8, 4 };
    std::string warnings;
    MakeOptions options;
    options.warn = [&](const std::string& line) { warnings += line; };
    for (const auto& [w, h, warned] :
         { std::tuple { 16, 16, true }, { 24, 16, true }, { 16, 8, false }, { 17, 9, false } }) {
        recipe.environment = folder / "probe.exr";
        ASSERT_TRUE(image(random_map(w, h, 3)).write(recipe.environment));
        OIIO::ImageBuf cfem;
        warnings.clear();
        ASSERT_TRUE(make_image(cfem, recipe, options)) << cfem.geterror();
        EXPECT_EQ(warnings.find("not twice as wide as high") != std::string::npos, warned) << w << "x" << h;
    }
    row.ours("refused if the file is tagged as a cube map; otherwise a warning about its shape");
}

TEST(Light, LargeMapsAreReadInStrips)
{
    extend_watchdog(5);
    HardCase row("An environment of 16384x8192");
    const vmlight::TemporaryFolder folder;
    const std::string path = folder / "large.exr";
    const int width = 16384, height = 8192;
    OIIO::ImageSpec spec(width, height, 3, OIIO::TypeHalf);
    spec.attribute("compression", "rle");
    const auto out = OIIO::ImageOutput::create(path);
    ASSERT_TRUE(out && out->open(path, spec));
    const std::vector<float> strip(size_t(3) * width * 64, 0.25f);
    for (int y = 0; y < height; y += 64)
        ASSERT_TRUE(out->write_scanlines(y, y + 64, 0, OIIO::TypeFloat, strip.data()));
    ASSERT_TRUE(out->close());

    CfemRecipe recipe;
    recipe.environment = path;
    recipe.cfem_params.resolution = { 16, 8 };
    forget_peak_of_memory();
    const long before = memory("VmRSS:");
    OIIO::ImageBuf cfem;
    ASSERT_TRUE(make_image(cfem, recipe, MakeOptions {})) << cfem.geterror();
    const long taken = memory("VmHWM:") - before;
    Map map(16, 8);
    ASSERT_TRUE(cfem.get_pixels(cfem.roi(), OIIO::TypeFloat, map.rgb.data()));
    EXPECT_EQ(map.rgb, Map(16, 8, 0.25f).rgb);
    row.naive("1.5 GiB of floats in memory before filtering starts");
    if (kMemoryIsOurs) {
        EXPECT_LT(taken, 450 * 1024);
    }
    RecordProperty("MiB", int(taken / 1024));
    row.ours("less than 450 MiB");
}
