// SPDX-License-Identifier: Apache-2.0
#include "lightmap_scene.h"

#include <vmlight/image/color.h>
#include <vmlight/lightmap/light_level.h>

using namespace vmlight;
using namespace scene;

namespace {

ImageBuf gray_ramp(int count, float step)
{
    ImageBuf image(ImageSpec(count, 1, 3, OIIO::TypeFloat));
    for (int x = 0; x < count; ++x) {
        const V3f c(step * float(x));
        image.setpixel(x, 0, &c.x, 3);
    }
    return image;
}

} // namespace

TEST(LightLevel, LuminanceIsThatOfTheWorkingSpace)
{
    // ITU-R BT.709; SMPTE ST 2065-1 and S-2014-004 (ACES AP0 and AP1).
    const struct
    {
        const char* id;
        std::array<double, 3> weights;
    } known[] = { { "", { 0.2126, 0.7152, 0.0722 } },
                  { "lin_rec709_scene", { 0.2126, 0.7152, 0.0722 } },
                  { "lin_ap1_scene", { 0.2722287, 0.6740818, 0.0536895 } },
                  { "lin_ap0_scene", { 0.3439664, 0.7281661, -0.0721325 } },
                  { "lin_ciexyzd65_scene", { 0, 1, 0 } } };
    for (const auto& [id, weights] : known) {
        ImageSpec spec(1, 1, 3, OIIO::TypeFloat);
        if (*id)
            tag_scene_linear(spec, id);
        for (size_t c = 0; c < 3; ++c)
            EXPECT_NEAR(luminance_weights(spec)[c], weights[c], 1e-4) << id << c;
        spec.erase_attribute("chromaticities"); // the id alone
        for (size_t c = 0; c < 3; ++c)
            EXPECT_NEAR(luminance_weights(spec)[c], weights[c], 1e-4) << id << c;
    }
    // Chromaticities overrule the id.
    ImageSpec spec(1, 1, 3, OIIO::TypeFloat);
    tag_scene_linear(spec, "lin_ap1_scene");
    spec.attribute("colorInteropID", "lin_rec709_scene");
    EXPECT_NEAR(luminance_weights(spec)[0], 0.2722287, 1e-4);
}

TEST(LightLevel, MeanAndPercentileOfARamp)
{
    // 0, .01, ... 1, of which 0 is not lit.
    const ImageBuf map = vismap(101, 1, [](int, int) { return VismapTexel { 1, V3f(0, 0, 2.0f / 3) }; });
    const LightLevel level = measure_light(gray_ramp(101, 0.01f), map);
    EXPECT_EQ(level.texels, 100);
    EXPECT_NEAR(level.mean, 0.505, 1e-6);
    EXPECT_NEAR(level.percentile95, 0.95, 1e-6);
    EXPECT_DOUBLE_EQ(level.gray_exposure(0).stops, std::round(100 * std::log2(0.18 / level.mean)) / 100);
    EXPECT_NEAR(level.mean * std::exp2(level.gray_exposure(0).stops), 0.18, 0.18 * 0.004);
}

TEST(LightLevel, CountsWhatTrianglesCoverOrWhatSeesAnything)
{
    // The left half is covered, three quarters see something.
    ImageSpec spec(8, 1, 5, OIIO::TypeFloat);
    spec.channelnames = { "visibility", "direction.x", "direction.y", "direction.z", "coverage" };
    ImageBuf covered(spec);
    for (int x = 0; x < 8; ++x)
        covered.setpixel(x, 0, std::array<float, 5> { x < 6 ? 1.0f : 0, 0, 0, 0.5f, x < 4 ? 1.0f : 0 }.data(), 5);
    const ImageBuf ramp = gray_ramp(8, 1);
    EXPECT_EQ(measure_light(ramp, covered).texels, 3);
    EXPECT_NEAR(measure_light(ramp, covered).mean, 2, 1e-6);
    const ImageBuf plain = vismap(8, 1, [](int x, int) { return VismapTexel { x < 6 ? 1.0f : 0, V3f(0) }; });
    EXPECT_EQ(measure_light(ramp, plain).texels, 5);
    EXPECT_NEAR(measure_light(ramp, plain).mean, 3, 1e-6);
}

TEST(LightLevel, NothingLitAndTooMuch)
{
    const ImageBuf map = vismap(2, 1, [](int, int) { return VismapTexel { 1, V3f(0) }; });
    EXPECT_EQ(measure_light(gray_ramp(2, 0), map).texels, 0);
    const GrayExposure none = measure_light(gray_ramp(2, 0), map).gray_exposure(0);
    EXPECT_EQ(none.stops, 0);
    EXPECT_FALSE(none.is_gray);
    const GrayExposure bright = measure_light(gray_ramp(2, 1e30f), map).gray_exposure(0);
    EXPECT_EQ(bright.stops, -64);
    EXPECT_NEAR(bright.mean, 1e30 * std::exp2(-64.0), 1e5);
    EXPECT_EQ(bright.advice(), "no --exposure brings the mean to 0.18: -64.00 brings it to 5.42e+10");
    EXPECT_EQ(measure_light(gray_ramp(2, 1e-30f), map).gray_exposure(0).stops, 64);
}

// Measured at an exposure, which counts: what it advises is a value that the flag takes.
TEST(LightLevel, AdviceIsOfTheWholeExposure)
{
    const ImageBuf map = vismap(2, 1, [](int, int) { return VismapTexel { 1, V3f(0) }; });
    const LightLevel dim = measure_light(gray_ramp(2, 1e-15f), map);
    EXPECT_EQ(dim.gray_exposure(0).advice(), "--exposure 47.35 brings the mean to 0.18");
    EXPECT_EQ(dim.gray_exposure(10).advice(), "--exposure 57.35 brings the mean to 0.18");
    EXPECT_EQ(dim.gray_exposure(30).advice(), "no --exposure brings the mean to 0.18: 64.00 brings it to 1.72e-05");
}
