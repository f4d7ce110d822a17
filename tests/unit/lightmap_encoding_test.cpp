// SPDX-License-Identifier: Apache-2.0
// Lightmaps that are encoded for engines, decoded as docs/export.md says.
#include "exported_image.h"

#include <vmlight/export/lightmap_encoding.h>
#include <vmlight/image/color.h>

#include <OpenImageIO/color.h>

#include <gmock/gmock.h>
#include <nlohmann/json.hpp>

#include <cmath>

using namespace vmlight;
using OIIO::ImageBuf;
using testing::HasSubstr;

namespace {

const std::vector<float> kLight { 0, 0, 0, 1, 0.5f, 0.25f, 3, 0.001f, 2.9f, 0.01f, 0.011f, 0.012f, 1e-5f, 0, 3 };

} // namespace

TEST(LightmapEncoding, RgbmDecodesWithinHalfAStepOfItsAlpha)
{
    const ImageBuf light = image_of(3, kLight);
    for (const TextureDepth depth : { TextureDepth::Eight, TextureDepth::Sixteen })
        for (double range : { 0.0, 8.0 }) {
            TextureFile file;
            std::string error;
            ASSERT_TRUE(encode_rgbm(file, light, range, depth, error)) << error;
            EXPECT_THAT(file.decode, HasSubstr("alpha * rgb"));
            EXPECT_GE(range, 3);
            const ImageBuf read = exported_image(file.bytes, "a.png");
            for (int x = 0; x < light.spec().width; ++x) {
                const double alpha = double(read.getchannel(x, 0, 0, 3));
                for (int c = 0; c < 3; ++c)
                    EXPECT_NEAR(range * alpha * double(read.getchannel(x, 0, 0, c)),
                                double(light.getchannel(x, 0, 0, c)),
                                0.5001 * range * alpha / largest_of(depth) + 1e-6);
            }
        }
    TextureFile file;
    std::string error;
    double range = 2;
    EXPECT_FALSE(encode_rgbm(file, light, range, TextureDepth::Eight, error));
    EXPECT_THAT(error, HasSubstr("its greatest value is 3"));
}

// The light from the files alone, as three.js' GainMapLoader decodes them.
TEST(LightmapEncoding, AGainMapDecodesWithinHalfAStepOfItsGain)
{
    for (const auto& values : { kLight, std::vector<float> { 0.25f, 0.25f, 0.25f, 0.25f, 0.25f, 0.25f },
                                std::vector<float> { 0, 0, 0, 0, 0, 5000 } })
        for (const TextureDepth depth : { TextureDepth::Eight, TextureDepth::Sixteen }) {
            const ImageBuf light = image_of(3, values);
            std::vector<LightmapFile> files;
            std::string error;
            ASSERT_TRUE(encode_lightmap(files, light, "gain_map", 0, depth, error)) << error;
            ASSERT_EQ(files.size(), 3u);
            const auto numbers = nlohmann::json::parse(files[2].texture.bytes);
            EXPECT_GT(numbers["hdrCapacityMax"].get<double>(), numbers["hdrCapacityMin"].get<double>());
            const ImageBuf base = exported_image(files[0].texture.bytes, "a.png"),
                           gain = exported_image(files[1].texture.bytes, "b.png");
            for (int x = 0; x < light.spec().width; ++x)
                for (int c = 0; c < 3; ++c) {
                    const double least = numbers["gainMapMin"][size_t(c)], most = numbers["gainMapMax"][size_t(c)],
                                 g = double(gain.getchannel(x, 0, 0, c)), truth = double(light.getchannel(x, 0, 0, c)),
                                 shown = double(OIIO::sRGB_to_linear(base.getchannel(x, 0, 0, c))),
                                 seen = (shown + numbers["offsetSdr"][size_t(c)].get<double>())
                            * std::exp2(least + (most - least) * g)
                        - numbers["offsetHdr"][size_t(c)].get<double>();
                    const double factor = std::exp2(0.5001 * (most - least) / largest_of(depth)) - 1;
                    EXPECT_NEAR(seen, truth, factor * (truth + 1.0 / 64) + 1e-6 * truth + 1e-7) << x << " " << c;
                    EXPECT_NEAR(shown, std::min(truth, 1.0), 2.3 / largest_of(depth)); // the steepest step of sRGB
                }
        }
}

TEST(LightmapEncoding, RgbeDecodesWithinA256thOfTheLargestChannel)
{
    const ImageBuf light = image_of(3, kLight);
    std::string hdr, error;
    ASSERT_TRUE(encode_rgbe(hdr, light, error)) << error;
    const ImageBuf read = exported_image(hdr, "a.hdr");
    for (int x = 0; x < light.spec().width; ++x) {
        const float most = std::max({ kLight[size_t(3 * x)], kLight[size_t(3 * x + 1)], kLight[size_t(3 * x + 2)] });
        for (int c = 0; c < 3; ++c)
            EXPECT_NEAR(read.getchannel(x, 0, 0, c), light.getchannel(x, 0, 0, c), most / 128) << x;
    }
}

// White stays white; red of ACEScg is beyond that of Rec.709, whose green is then negative.
TEST(LightmapEncoding, EnginesGetRec709)
{
    ImageBuf light = image_of(3, { 1, 1, 1, 1, 0, 0 }), engine;
    std::string error;
    tag_scene_linear(light.specmod(), "lin_ap1_scene");
    ASSERT_TRUE(engine_light(engine, light, error)) << error;
    for (int c = 0; c < 3; ++c)
        EXPECT_NEAR(engine.getchannel(0, 0, 0, c), 1, 1e-4f);
    EXPECT_NEAR(engine.getchannel(1, 0, 0, 0), 1.705f, 2e-3f);
    EXPECT_EQ(engine.getchannel(1, 0, 0, 1), 0);
    tag_scene_linear(light.specmod(), "lin_rec709_scene");
    ASSERT_TRUE(engine_light(engine, light, error)) << error;
    EXPECT_EQ(engine.getchannel(1, 0, 0, 0), 1);
    tag_scene_linear(light.specmod(), "lin_crayon_scene");
    EXPECT_FALSE(engine_light(engine, light, error));
    EXPECT_THAT(error, HasSubstr("lin_crayon_scene"));
    light = image_of(3, { 1, NAN, 1 });
    EXPECT_FALSE(engine_light(engine, light, error));
    EXPECT_THAT(error, HasSubstr("pixel (0, 0) is nan"));
}
