// SPDX-License-Identifier: Apache-2.0
// Light at the ends of its range, of any shape of map.
#include "hard_case.h"

#include "cfem_maps.h"
#include "lightmap_scene.h"
#include "temporary_folder.h"

#include <vmlight/base/format.h>
#include <vmlight/cfem/rows.h>
#include <vmlight/cfem/stack.h>
#include <vmlight/image/color.h>
#include <vmlight/image/image_file.h>

#include <OpenImageIO/imagebufalgo.h>
#include <OpenImageIO/strutil.h>

#include <Imath/half.h>

#include <cfloat>
#include <limits>

using namespace cfem_maps;
using vmlight::format;

namespace {

// Light times cosine, summed over all texels: what anyone writes first. `number` is what it is summed in.
template <class Number> Number naive_light(const Map& map, const V3d& n)
{
    Number sum = 0;
    for (int y = 0; y < map.height; ++y)
        for (int x = 0; x < map.width; ++x) {
            const double weight = brute::solid_angle(y, map.width, map.height) / pi;
            sum += Number(map.at(x, y)[0] * Number(weight * std::max(0.0, n.dot(center(x, y, map.width, map.height)))));
        }
    return sum;
}

template <class Number> int naive_texels_not_finite(const Map& map)
{
    int count = 0;
    for (int y = 0; y < 16; ++y)
        for (int x = 0; x < 32; ++x)
            count += !std::isfinite(naive_light<Number>(map, center(x, y, 32, 16)));
    return count;
}

int texels_not_finite(const Map& map)
{
    return int(std::count_if(map.rgb.begin(), map.rgb.end(), [](float value) { return !std::isfinite(value); }));
}

// Every texel of a result against `value`, in units of the last place of float.
double worst_ulps(const Map& map, float value)
{
    const double ulp = std::nextafter(value, std::numeric_limits<float>::infinity()) - double(value);
    return largest_error(map, [&](const V3d&) { return V3d(value); }) / ulp;
}

OIIO::ImageBuf half_of(const OIIO::ImageBuf& image)
{
    OIIO::ImageBuf half;
    EXPECT_TRUE(half.copy(image, OIIO::TypeHalf));
    return half;
}

} // namespace

TEST(Light, AnInfiniteTexel)
{
    HardCase row("An environment with one infinite texel",
                 "OIIO PR#2301, PR#2892: such pixels misreported, or clamped");
    Map map(64, 32, 1);
    map.at(20, 9)[0] = INFINITY;
    row.naive(
        format("{} of 512 directions of the filtered map are NaN or infinite", naive_texels_not_finite<double>(map)));
    EXPECT_EQ(naive_texels_not_finite<double>(map), 512); // 0 x infinity on the dark side
    EXPECT_NE(refusal(image(map)).find("environment has 1 value that is NaN or infinite, at pixel (20, 9)"),
              std::string::npos);
    CfemParams mend = exact(32, 16);
    mend.sanitize = true;
    EXPECT_LE(worst_ulps(filtered(image(map), mend), 1), 1);
    row.ours("refused, with the count and the first pixel; `--sanitize` repairs it from its neighbours");
}

TEST(Light, TexelsThatAreNoNumbers)
{
    HardCase row("An environment with one row of NaN");
    Map map(64, 32, 1);
    std::fill_n(map.at(0, 31), 3 * 64, NAN);
    EXPECT_EQ(naive_texels_not_finite<double>(map), 512);
    row.naive("512 of 512 directions of the filtered map are NaN");
    EXPECT_NE(refusal(image(map)).find("192 values that are NaN or infinite, the first at pixel (0, 31)"),
              std::string::npos);
    CfemParams mend = exact(32, 16);
    mend.sanitize = true;
    EXPECT_LE(worst_ulps(filtered(image(map), mend), 1), 1);
    row.ours("refused, with the count and the first pixel; `--sanitize` repairs it");
}

TEST(Light, NegativeTexels)
{
    HardCase row("A resampled environment with negative ringing around its sun",
                 "SH light goes negative: filament#744, godot PR#58164");
    Map map(64, 32, 0);
    std::fill_n(map.at(12, 10), 3, -5.0f);
    EXPECT_LT(naive_light<double>(map, center(12, 10, 64, 32)), 0);
    row.naive("negative light on surfaces");
    EXPECT_NE(refusal(image(map)).find("3 values that are negative, the first at pixel (12, 10)"), std::string::npos);
    CfemParams mend = exact(32, 16);
    mend.sanitize = true;
    EXPECT_EQ(filtered(image(map), mend).rgb, Map(32, 16).rgb);
    row.ours("refused, with the count and the first pixel; `--sanitize` sets it to 0");
}

TEST(Light, AsFaintAsFloatsGet)
{
    HardCase row("Light of 1e-42, a denormal");
    const Map map(512, 256, 1e-42f);
    EXPECT_EQ(naive_light<float>(map, V3d(0, 0, 1)), 0);
    row.naive("black: every float product underflows to 0");
    EXPECT_LE(worst_ulps(filtered_anyway(map, 32, 16), 1e-42f), 1);
    row.ours("1e-42, to 1 ulp");
}

TEST(Light, AsBrightAsFloatsGet)
{
    HardCase row("Light of 1e30 to 3.4e38, the largest float");
    Map map(64, 32, FLT_MAX);
    map.at(3, 3)[0] = 0; // not constant
    float irradiance = 0;
    for (int y = 0; y < 32; ++y)
        for (int x = 0; x < 64; ++x)
            irradiance
                += map.at(x, y)[0] * float(brute::solid_angle(y, 64, 32) * std::max(0.0, center(x, y, 64, 32).z));
    EXPECT_TRUE(std::isinf(irradiance));
    row.naive("irradiance overflows float, and so does irradiance / pi");
    EXPECT_EQ(texels_not_finite(filtered(map, 32, 16)), 0);
    for (const float value : { 1e30f, FLT_MAX })
        EXPECT_LE(worst_ulps(filtered_anyway(Map(64, 32, value), 32, 16), value), 1);
    LightmapParams params;
    params.exposure = 1;
    OIIO::ImageBuf dst;
    EXPECT_FALSE(make_lightmap(dst, scene::random_vismap(8, 8), image(Map(4, 2, FLT_MAX)), params));
    EXPECT_NE(dst.geterror().find("too large"), std::string::npos) << dst.geterror();
    row.ours("finite everywhere, constant light to 1 ulp; a product beyond float is refused");
}

TEST(Light, ASunInHalfFloats)
{
    HardCase row("A sun of 1e6 written as half, whose maximum is 65504",
                 "half clamped or infinite: OIIO PR#2892, #4171; cmft#6");
    Map map(64, 32, 1);
    std::fill_n(map.at(20, 9), 3, 1e6f);
    EXPECT_TRUE(Imath::half(1e6f).isInfinity());
    Map clamped = map;
    std::fill_n(clamped.at(20, 9), 3, 65504.0f);
    const double kept = brute::mean(clamped)[0] / brute::mean(map)[0];
    row.naive(format("infinite; or clamped, losing {:.0f} % of all light", 100 * (1 - kept)));
    EXPECT_LT(kept, 0.2);

    const vmlight::TemporaryFolder folder;
    std::string error;
    EXPECT_FALSE(write_image(image(map), folder / "sun.exr", { "half" }, {}, error));
    EXPECT_NE(error.find("the maximum of half is 65504: write float"), std::string::npos) << error;
    EXPECT_TRUE(folder.names().empty());
    ASSERT_TRUE(write_image(image(map), folder / "sun.exr", {}, {}, error)) << error;
    ASSERT_TRUE(write_image(image(Map(64, 32, 65504)), folder / "brightest.exr", { "half" }, {}, error)) << error;
    // Where half has clipped already, infinity is told, not filtered.
    EXPECT_NE(refusal(half_of(image(map))).find("3 values that are NaN or infinite"), std::string::npos);
    row.ours("refused, with the value and what to do; environments and CFEMs are float by default");
}

TEST(Light, ASunOfOneTexelAnywhere)
{
    HardCase row("A sun of one texel, 1e6 times as bright as the rest: at a pole, on the seam, cut by the horizon");
    double naive = 0, ours = 0;
    const int places[][2] = { { 0, 0 }, { 40, 0 }, { 0, 15 }, { 63, 20 }, { 17, 16 }, { 5, 31 } };
    for (const auto& place : places)
        each_light_of_hot_texel(place[0], place[1], [&](const HotTexelLight& light) {
            const double points = naive_light<double>(light.map, light.normal);
            naive = std::max(naive, std::abs(points - light.truth) / light.mean);
            ours = std::max(ours, std::abs(light.filtered - light.truth) / light.mean);
        });
    EXPECT_GT(naive, 1e-2);
    row.naive("texels as points: an error of more than 1 % of the mean light at the horizon");
    EXPECT_LT(ours, 6e-5);
    row.ours("within 6e-5 of the mean light");
}

TEST(Light, FaintLightBesideASun)
{
    HardCase row("A surface facing away from a sun of 1e8, lit by a sky of 1e-3");
    Map map(256, 128, 1e-3f);
    std::fill_n(map.at(37, 50), 3, 1e8f);
    const V3d away = -center(37, 50, 256, 128);
    // Prefix sums, which make a filter fast, as floats.
    std::vector<float> sums { 0 };
    for (int y = 0; y < map.height; ++y)
        for (int x = 0; x < map.width; ++x)
            sums.push_back(sums.back() + map.at(x, y)[0]);
    const float after = sums.back() - sums[size_t(60) * 256];
    EXPECT_EQ(after, 0);
    row.naive("prefix sums in float: black");
    const Map cfem = filtered(map, 32, 16);
    double worst = 0;
    for (int y = 0; y < 16; ++y)
        for (int x = 0; x < 32; ++x)
            if (away.dot(center(x, y, 32, 16)) > 0.05)
                worst = std::max(worst, std::abs(cfem.at(x, y)[0] / 1e-3 - 1));
    EXPECT_LT(worst, 1e-5);
    row.ours("1e-3, within a relative error of 1e-5");
}

TEST(Light, WhatIsNoLight)
{
    HardCase row(
        "An environment with only a depth, an alpha, a normal or an unnamed channel, or with motion vectors; a "
        "cropped CFEM");
    row.naive("the channel is taken for grey light; the crop is stretched over the whole sphere");
    std::string error;
    for (const std::vector<std::string>& channels : std::vector<std::vector<std::string>> {
             { "Z" }, { "A" }, { "depth.Z" }, { "mask.A" }, { "N.X" }, { "foo" }, { "R" }, { "U", "Y", "V" } }) {
        OIIO::ImageSpec spec(16, 8, int(channels.size()), OIIO::TypeFloat);
        spec.channelnames = channels;
        OIIO::ImageBuf cfem;
        EXPECT_FALSE(make_cfem(cfem, OIIO::ImageBuf(spec), exact(8, 4)));
        EXPECT_EQ(
            cfem.geterror(),
            vmlight::format("environment: no channels R, G, B, and no Y of grey, among {}; if one of them is light, "
                            "name it with oiiotool --ch NAME,NAME,NAME --chnames R,G,B",
                            OIIO::Strutil::join(channels, ", ")));
    }
    OIIO::ImageBuf crop = image(Map(8, 4, 1)), dst;
    crop.specmod().full_height = 8;
    EXPECT_FALSE(make_lightmap(dst, scene::random_vismap(4, 4), crop));
    EXPECT_EQ(dst.geterror(), "cosine-filtered environment is cropped: it stores 8x4 pixels of 8x8");
    row.ours("refused");
}

TEST(Light, ALabelAgainstARule)
{
    HardCase row(
        "An EXR whose label says linear Rec.709, where the OCIO config's rule for .exr says ACEScg; the same with "
        "the history of a conversion that left the label",
        "oiiotool: the rule; --tocolorspace and maketx --colorconvert keep the label");
    row.naive("by the rule: 26 % too red; by the stale label: any colour");
    std::string note, error;
    OIIO::ImageBuf sky = image(Map(8, 4, 1));
    OIIO::ImageBufAlgo::fill(sky, { 0.5f, 0.25f, 0.125f });
    sky.specmod().attribute("colorInteropID", "lin_rec709_scene");
    OIIO::ImageBuf stale = sky.copy(OIIO::TypeFloat);
    stale.specmod().attribute("Software", "OpenImageIO 2.4.7.1 : oiiotool a.exr --tocolorspace ACEScg -o b.exr");
    ASSERT_TRUE(to_scene_linear(sky, "sky.exr", { VMLIGHT_TEST_OCIO, "" }, note, error)) << error;
    float pixel[3];
    sky.getpixel(0, 0, pixel, 3);
    EXPECT_NEAR(pixel[0], 0.397352f, 2e-5f);
    EXPECT_FALSE(to_scene_linear(stale, "sky.exr", { VMLIGHT_TEST_OCIO, "" }, note, error));
    EXPECT_NE(error.find("set --colorspace"), std::string::npos) << error;
    row.ours("the label's colour; refused, naming `--colorspace`");
}

TEST(Light, Blackness)
{
    HardCase row("A black environment");
    row.naive("0/0 = NaN from every division by the mean light");
    std::vector<OIIO::ImageBuf> stack;
    std::string error;
    ASSERT_TRUE(make_cfem_stack(stack, image(Map(64, 32)), exact(32, 16), error)) << error;
    for (const OIIO::ImageBuf& level : stack) {
        Map map(32, 16, NAN);
        ASSERT_TRUE(level.get_pixels(level.roi(), OIIO::TypeFloat, map.rgb.data()));
        EXPECT_EQ(map.rgb, Map(32, 16).rgb);
    }
    const OIIO::ImageBuf vm = scene::random_vismap(16, 16);
    for (const char* model : { "paper", "lobe", "auto" }) {
        LightmapParams params;
        params.model = model;
        OIIO::ImageBuf dst;
        ASSERT_TRUE(make_lightmap(dst, vm, stack, params)) << dst.geterror();
        for (OIIO::ImageBuf::ConstIterator<float> p(dst); !p.done(); ++p)
            EXPECT_TRUE(p[0] == 0 && p[1] == 0 && p[2] == 0);
    }
    row.ours("0 at every texel of all ten images of a stack and of the lightmap");
}
