// SPDX-License-Identifier: Apache-2.0
#include "stack_maps.h"

#include <vmlight/cfem/radiance.h>

using namespace vmlight;
using namespace scene;

namespace {

V3d light_of(const ImageBuf& image)
{
    V3d sum(0);
    for (int y = 0; y < image.spec().height; ++y)
        for (int x = 0; x < image.spec().width; ++x)
            sum += V3d(color(image, x, y)) * latlong::row_solid_angle(y, image.spec().height) / image.spec().width;
    return sum;
}

ImageBuf radiance(const ImageBuf& env, int width, int height)
{
    ImageBuf dst;
    CfemParams params;
    params.resolution = { width, height };
    std::string error;
    EXPECT_TRUE(make_radiance(dst, env, params, error)) << error;
    return dst;
}

} // namespace

TEST(Radiance, KeepsTheLightOfTheSphereAtEverySize)
{
    for (const auto& [width, height] : { std::pair { 64, 32 }, { 50, 21 }, { 7, 3 }, { 1, 1 } }) {
        ImageBuf env = random_cfem(width, height);
        const float sun[3] { 1e6f, 2e6f, 3e6f };
        env.setpixel(width / 3, height / 4, sun, 3);
        for (const auto& [to_width, to_height] : { std::pair { 16, 8 }, { 64, 32 }, { 37, 11 }, { 1, 1 } }) {
            const ImageBuf small = radiance(env, to_width, to_height);
            EXPECT_EQ(small.spec().width, to_width);
            for (int c = 0; c < 3; ++c)
                EXPECT_NEAR(light_of(small)[c], light_of(env)[c], 2e-6 * light_of(env)[c]) << width << " " << to_width;
        }
    }
}

TEST(Radiance, OfTheSameSizeIsTheEnvironment)
{
    const ImageBuf env = random_cfem(24, 12);
    EXPECT_LT(difference(radiance(env, 24, 12), env), 1e-6f);
    const ImageBuf twice = radiance(env, 48, 24);
    for (int y = 0; y < 24; ++y)
        for (int x = 0; x < 48; ++x)
            EXPECT_NEAR(color(twice, x, y).x, color(env, x / 2, y / 2).x, 1e-6f);
}

TEST(Radiance, IsTheLastImageOfAStack)
{
    const ImageBuf env = random_cfem(32, 16);
    const std::vector<ImageBuf> stack = filtered_stack(env, 32);
    ASSERT_EQ(int(stack.size()), kStackImages);
    EXPECT_EQ(find_radiance(stack), &stack[kStackLevels]);
    EXPECT_TRUE(same_bits(stack[kStackLevels], radiance(env, 32, 16)));
    EXPECT_EQ(find_radiance(OIIO::cspan<ImageBuf>(stack.data(), kStackLevels)), nullptr);
    EXPECT_TRUE(has_all_light(stack));
    EXPECT_TRUE(has_all_light(OIIO::cspan<ImageBuf>(&stack[kStackLevels], 1)));
    EXPECT_FALSE(has_all_light(OIIO::cspan<ImageBuf>(&stack[0], 1)));
}

TEST(Radiance, RefusesWhatAFilterRefuses)
{
    ImageBuf env = random_cfem(16, 8), dst;
    pixels(env)[5] = NAN;
    std::string error;
    EXPECT_FALSE(make_radiance(dst, env, {}, error));
    EXPECT_NE(error.find("NaN or infinite"), std::string::npos) << error;
    CfemParams mend;
    mend.sanitize = true;
    EXPECT_TRUE(make_radiance(dst, env, mend, error));
    EXPECT_EQ(dst.spec().get_int_attribute("vmlight:sanitized"), 1);
    EXPECT_FALSE(make_radiance(dst, ImageBuf(), {}, error));
    EXPECT_FALSE(make_radiance(dst, random_cfem(16, 8), {}, error, [](double) { return false; }));
    EXPECT_EQ(error, "interrupted");
}
