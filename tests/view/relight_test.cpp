// SPDX-License-Identifier: Apache-2.0
#include "view_test.h"

#include "vmview/relight/relight_pass.h"

#include <vmlight/frame/texture_pyramid.h>

#include <OpenImageIO/strutil.h>

using namespace vmlight;
using namespace vmlight::view;

namespace {

using Relight = DrawingTest;

std::vector<float> relit(const OIIO::ImageBuf& map, const std::vector<OIIO::ImageBuf>& stack,
                         const LightmapParams& params)
{
    RelightPass pass;
    MapTextures textures;
    LightTextures light;
    LitTexture lit;
    std::string error;
    const std::vector<float> everywhere(map.spec().image_pixels(), 1.0f);
    EXPECT_TRUE(pass.build(error) && textures.load(map, everywhere, error) && light.load(stack, error)
                && pass.run(lit, textures, light, &stack.back(), nullptr, params, error))
        << error;
    const std::vector<float> rgba = lit.read();
    std::vector<float> rgb;
    for (size_t i = 0; i < rgba.size(); i += 4)
        rgb.insert(rgb.end(), { rgba[i], rgba[i + 1], rgba[i + 2] });
    return rgb;
}

std::vector<float> lit_on_cpu(const OIIO::ImageBuf& map, const std::vector<OIIO::ImageBuf>& stack,
                              const LightmapParams& params)
{
    OIIO::ImageBuf lightmap;
    EXPECT_TRUE(make_lightmap(lightmap, map, stack, params)) << lightmap.geterror();
    const auto* pixels = static_cast<const float*>(lightmap.localpixels());
    return { pixels, pixels + 3 * lightmap.spec().image_pixels() };
}

} // namespace

// Measured on llvmpipe: the same bits but for division and square root, at most 2e-6 of the mean.
TEST_F(Relight, EqualsMakeLightmap)
{
    const OIIO::ImageBuf map = full_map(data_mesh("spot.obj"), { 128, 96 });
    double worst = 0;
    const std::vector<std::vector<double>> rotations { {}, { 0, 90, 0 }, { 20, 130, -70 } };
    for (const char* environment : { "studio_small_03.hdr", "kloppenheim_05.hdr" }) {
        // An odd width moves the seam from between texels to the middle of one.
        for (const Size size : { Size { 128, 64 }, Size { 63, 32 } }) {
            const std::vector<OIIO::ImageBuf> stack = data_light(environment, size);
            for (const char* model : { "ao", "paper", "lobe", "sh" })
                for (const auto& rotate : rotations) {
                    LightmapParams params;
                    params.model = model;
                    params.rotate = rotate;
                    params.exposure = -0.5;
                    const double error = largest_difference(relit(map, stack, params), lit_on_cpu(map, stack, params));
                    worst = std::max(worst, error);
                    EXPECT_LT(error, 1e-5) << model << " " << environment << " " << size.width;
                }
        }
    }
    RecordProperty("worst", OIIO::Strutil::sprintf("%.3g", worst));
}

TEST_F(Relight, PyramidEqualsThatOfFrames)
{
    // Sizes that halve to odd ones, so that some texels are the mean of parts of three.
    const int width = 53, height = 30;
    std::vector<float> rgb, weights;
    for (int i = 0; i < width * height; ++i) {
        for (int c = 0; c < 3; ++c)
            rgb.push_back(float((i * 7919 + c * 104729) % 1000) / 1000);
        weights.push_back(i % 5 ? 1.0f : 0.0f);
    }
    LitTexture lit(width, height);
    PyramidPass pass;
    std::string error;
    ASSERT_TRUE(pass.build(error)) << error;
    for (const float scale : { 1.0f, 0.25f }) { // filled again, after its levels were used
        for (float& value : rgb)
            value *= scale;
        lit.fill(rgb.data(), weights);
        pass.run(lit);
        const TexturePyramid pyramid(width, height, 3, rgb.data(), weights.data());
        ASSERT_EQ(size_t(lit.levels()), pyramid.levels().size());
        for (int level = 0; level < lit.levels(); ++level) {
            const Framebuffer& framebuffer = lit.level(level);
            std::vector<float> texels(4 * size_t(framebuffer.width()) * size_t(framebuffer.height()));
            framebuffer.read(texels.data());
            EXPECT_LT(largest_difference(texels, pyramid.levels()[size_t(level)].texels), 1e-6) << level;
        }
    }
}

// A constant environment lights every texel that sees all of its hemisphere with that constant.
TEST_F(Relight, ConstantLightIsConstant)
{
    OIIO::ImageBuf environment(OIIO::ImageSpec(16, 8, 3, OIIO::TypeFloat));
    for (OIIO::ImageBuf::Iterator<float> pixel(environment); !pixel.done(); ++pixel)
        for (int c = 0; c < 3; ++c)
            pixel[c] = 0.25f * float(c + 1);
    std::vector<OIIO::ImageBuf> stack;
    std::string error;
    ASSERT_TRUE(make_cfem_stack(stack, environment, {}, error)) << error;
    const OIIO::ImageBuf map = full_map(square(), { 16, 16 });
    for (const char* model : { "ao", "paper", "lobe", "sh" }) {
        LightmapParams params;
        params.model = model;
        params.rotate = { 10, 20, 30 };
        const std::vector<float> rgb = relit(map, stack, params);
        for (size_t i = 0; i < rgb.size(); ++i)
            ASSERT_NEAR(rgb[i], 0.25 * double(i % 3 + 1), 1e-5) << model;
    }
}
