// SPDX-License-Identifier: Apache-2.0
#include "cfem_maps.h"
#include "scenes.h"
#include "strand_bake.h"

#include <vmlight/cfem/radiance.h>
#include <vmlight/cfem/stack.h>
#include <vmlight/image/channels.h>
#include <vmlight/lightmap/lightmap.h>
#include <vmlight/lightmap/model.h>

#include <gmock/gmock.h>

#include <cmath>
#include <utility>
#include <vector>

using namespace cfem_maps;
using namespace vmlight::strand_files;
using strand_bake::rays;
using strand_bake::strand_map;

namespace {

CfemParams of_strands(int width, int height)
{
    CfemParams params = exact(width, height);
    params.kernel = "strand";
    return params;
}

// The parts of a map's pixels that are not black: each one's direction, and its light times its solid angle.
std::vector<std::pair<V3d, double>> lit_parts(const Map& sky)
{
    constexpr int kParts = 8;
    std::vector<std::pair<V3d, double>> parts;
    const int width = sky.width * kParts, height = sky.height * kParts;
    for (int y = 0; y < height; ++y)
        for (int pixel = 0; pixel < sky.width; ++pixel) {
            const float light = sky.at(pixel, y / kParts)[0];
            for (int x = pixel * kParts; light != 0 && x < (pixel + 1) * kParts; ++x)
                parts.emplace_back(center(x, y, width, height), light * brute::solid_angle(y, width, height));
        }
    return parts;
}

// (1/pi^2) Int L sin(t, w) dw, part by part.
double gathered(const std::vector<std::pair<V3d, double>>& parts, const V3d& tangent)
{
    double sum = 0;
    for (const auto& [direction, light] : parts)
        sum += light * direction.cross(tangent).length();
    return sum / (pi * pi);
}

Map uneven_sky()
{
    Map sky(32, 16);
    for (int y = 0; y < 16; ++y)
        for (int x = 0; x < 32; ++x)
            for (int c = 0; c < 3; ++c)
                sky.at(x, y)[c] = .2f + float((x * 7 + y * 13) % 11) + (y < 8 ? 4.f : 0.f);
    return sky;
}

// Two crossing strands above a floor.
Strands crossing()
{
    return straight({ { V3d(-1, 0, 0), V3d(1, .3, 0) }, { V3d(0, .4, -1), V3d(0, .4, 1) } }, .05);
}
std::vector<Mesh> low_floor()
{
    return { scenes::quad(V3d(-3, -.5, 3), V3d(3, -.5, 3), V3d(3, -.5, -3), V3d(-3, -.5, -3)) };
}

OIIO::ImageBuf map_with(const char* basis, const Strands& strands, const std::vector<Mesh>& occluders)
{
    VismapParams params = rays(64);
    params.basis = basis;
    return strand_map(strands, occluders, params);
}

/// The environment itself, as the model sh takes it.
OIIO::ImageBuf unfiltered(const Map& sky)
{
    OIIO::ImageBuf light;
    std::string error;
    EXPECT_TRUE(make_radiance(light, image(sky), exact(sky.width, sky.height), error)) << error;
    return light;
}

/// A stack for strands.
std::vector<OIIO::ImageBuf> strand_stack(const Map& sky, int width, int height)
{
    std::vector<OIIO::ImageBuf> images;
    std::string error;
    EXPECT_TRUE(make_cfem_stack(images, image(sky), of_strands(width, height), error)) << error;
    return images;
}

LightmapParams model_entry(const char* name)
{
    LightmapParams params;
    params.model = name;
    return params;
}

std::string strand_refusal(const OIIO::ImageBuf& map, const OIIO::ImageBuf& light, const char* name)
{
    OIIO::ImageBuf lit;
    EXPECT_FALSE(make_lightmap(lit, map, light, model_entry(name))) << name;
    return lit.geterror();
}

} // namespace

TEST(StrandCfem, AConstantLightStaysAsItIs)
{
    CfemParams params = of_strands(32, 16);
    for (const bool skip : { true, false }) {
        params.skip_one_color = skip;
        const Map filtered = cfem_maps::filtered(image(Map(64, 32, .75f)), params);
        for (const float value : filtered.rgb)
            EXPECT_NEAR(value, .75f, 2e-7);
    }
}

TEST(StrandCfem, IsTheSumOverThePixelsTimesTheSine)
{
    const Map sky = uneven_sky(), filtered = cfem_maps::filtered(image(sky), of_strands(16, 8));
    const auto parts = lit_parts(sky);
    for (int y = 0; y < 8; ++y)
        for (int x = 0; x < 16; ++x) {
            const double truth = gathered(parts, center(x, y, 16, 8));
            EXPECT_NEAR(filtered.at(x, y)[0], truth, 5e-4 * truth) << x << " " << y;
        }
}

TEST(StrandCfem, APointOfLightIsTheSineItself)
{
    Map sky(128, 64);
    sky.at(40, 20)[0] = 1000;
    const Map filtered = cfem_maps::filtered(image(sky), of_strands(64, 32));
    const auto parts = lit_parts(sky);
    double peak = 0, worst = 0;
    for (int y = 0; y < 32; ++y)
        for (int x = 0; x < 64; ++x) {
            const double truth = gathered(parts, center(x, y, 64, 32));
            peak = std::max(peak, truth);
            worst = std::max(worst, std::abs(filtered.at(x, y)[0] - truth));
            EXPECT_GE(filtered.at(x, y)[0], 0);
        }
    EXPECT_LT(worst, .008 * peak);
}

TEST(StrandCfem, ItsKernelIsInTheMetadata)
{
    OIIO::ImageBuf strands, surfaces;
    ASSERT_TRUE(make_cfem(strands, image(uneven_sky()), of_strands(8, 4)));
    EXPECT_EQ(strands.spec().get_string_attribute("vmlight:kernel"), "strand");
    ASSERT_TRUE(make_cfem(surfaces, image(uneven_sky()), exact(8, 4)));
    EXPECT_EQ(surfaces.spec().find_attribute("vmlight:kernel"), nullptr);
    CfemParams wrong = exact(8, 4);
    wrong.kernel = "sine";
    EXPECT_FALSE(make_cfem(strands, image(uneven_sky()), wrong));
    EXPECT_NE(strands.geterror().find("\"sine\""), std::string::npos);
}

TEST(StrandLight, AConstantEnvironmentGivesV)
{
    const OIIO::ImageBuf map = map_with("sh", crossing(), low_floor());
    const std::vector<OIIO::ImageBuf> stack = strand_stack(Map(16, 8, .5f), 16, 8);
    for (const char* name : { "ao", "lobe", "sh" }) {
        OIIO::ImageBuf lit;
        LightmapParams params = model_entry(name);
        params.skip_one_color = false;
        ASSERT_TRUE(make_lightmap(lit, map, stack, params)) << lit.geterror();
        for (int y = 0; y < 2; ++y)
            for (int x = 0; x < 8; ++x)
                EXPECT_NEAR(lit.getchannel(x, y, 0, 0), .5f * map.getchannel(x, y, 0, 0), 1e-6) << name;
    }
}

TEST(StrandLight, AnOpenStrandHasTheLightAroundItsTangent)
{
    const Strands oblique = straight({ { V3d(0), V3d(1, 2, 2) } }, .01);
    const Map sky = uneven_sky();
    const double truth = gathered(lit_parts(sky), V3d(1, 2, 2) / 3.0);
    OIIO::ImageBuf light, ao, sh;
    ASSERT_TRUE(make_cfem(light, image(sky), of_strands(128, 64)));
    const OIIO::ImageBuf map = map_with("sh", oblique, {});
    ASSERT_TRUE(make_lightmap(ao, map, light, model_entry("ao"))) << ao.geterror();
    EXPECT_NEAR(ao.getchannel(3, 0, 0, 0), truth, 1e-3 * truth);
    OIIO::ImageBuf lobe;
    ASSERT_TRUE(make_lightmap(lobe, map, strand_stack(sky, 128, 64), model_entry("lobe"))) << lobe.geterror();
    EXPECT_NEAR(lobe.getchannel(3, 0, 0, 0), ao.getchannel(3, 0, 0, 0), 1e-5 * truth);
    // Without the bands from 6 on, where the sine has less than .005.
    ASSERT_TRUE(make_lightmap(sh, map, unfiltered(sky), model_entry("sh"))) << sh.geterror();
    EXPECT_NEAR(sh.getchannel(3, 0, 0, 0), truth, .01 * truth);
}

// The moments of the light that reaches a strand are those of V and B.
TEST(StrandLight, LobeIsExactForLightThatIsLinearInDirection)
{
    const V3d slope(.3, .5, -.2);
    Map sky(128, 64);
    for (int y = 0; y < sky.height; ++y)
        for (int x = 0; x < sky.width; ++x)
            std::fill_n(sky.at(x, y), 3, float(1 + slope.dot(center(x, y, sky.width, sky.height))));
    const std::vector<OIIO::ImageBuf> stack = strand_stack(sky, 128, 64);
    std::vector<Mesh> around = low_floor();
    for (const bool has_wall : { false, true }) { // with it, all that is open lies to one side
        if (has_wall)
            around.push_back(scenes::quad(V3d(-3, -3, -.1), V3d(3, -3, -.1), V3d(3, 3, -.1), V3d(-3, 3, -.1)));
        const OIIO::ImageBuf map = map_with("vector", crossing(), around);
        OIIO::ImageBuf lit;
        ASSERT_TRUE(make_lightmap(lit, map, stack, model_entry("auto"))) << lit.geterror();
        EXPECT_EQ(lit.spec().get_string_attribute("vmlight:model"), "lobe");
        for (int y = 0; y < 2; ++y)
            for (int x = 0; x < 8; ++x) {
                float texel[7];
                map.getpixel(x, y, texel, 7);
                const V3d b(texel[1], texel[2], texel[3]);
                EXPECT_EQ(b.length() > .5 * double(texel[0]), has_wall) << x << " " << y; // no light around the tangent
                EXPECT_NEAR(double(lit.getchannel(x, y, 0, 0)), double(texel[0]) + slope.dot(b), 5e-4) << x << " " << y;
            }
    }
}

TEST(StrandLight, AboveAFloorLobeIsOffByLessThanHalfAsMuchAsAo)
{
    const Strands low = straight({ { V3d(-.1, 0, 0), V3d(.1, 0, 0) } }, .001);
    const std::vector<Mesh> floor { scenes::quad(V3d(-500, -.01, 500), V3d(500, -.01, 500), V3d(500, -.01, -500),
                                                 V3d(-500, -.01, -500)) };
    const Map sky = uneven_sky();
    Map upper = sky;
    for (int y = sky.height / 2; y < sky.height; ++y)
        std::fill_n(upper.at(0, y), 3 * size_t(sky.width), 0.f);
    const double truth = gathered(lit_parts(upper), V3d(1, 0, 0));
    const std::vector<OIIO::ImageBuf> stack = strand_stack(sky, 64, 32);
    const OIIO::ImageBuf map = strand_map(low, floor, rays(1024));
    double off[2];
    for (const bool is_lobe : { false, true }) {
        OIIO::ImageBuf lit;
        ASSERT_TRUE(make_lightmap(lit, map, stack, model_entry(is_lobe ? "lobe" : "ao"))) << lit.geterror();
        off[is_lobe] = std::abs(double(lit.getchannel(3, 0, 0, 0)) - truth) / truth;
    }
    EXPECT_GT(off[0], .1);
    EXPECT_LT(off[1], .5 * off[0]);
}

TEST(StrandLight, ModelsAndLightOfSurfacesAreRefused)
{
    OIIO::ImageBuf strands, surfaces, lit;
    const OIIO::ImageBuf sky = image(uneven_sky());
    ASSERT_TRUE(make_cfem(strands, sky, of_strands(16, 8)));
    ASSERT_TRUE(make_cfem(surfaces, sky, exact(16, 8)));
    const OIIO::ImageBuf map = map_with("vector", crossing(), {});
    for (const ModelEntry& entry : model_entries()) {
        if (entry.strand_rank > 0)
            continue;
        EXPECT_THAT(strand_refusal(map, strands, entry.name), testing::HasSubstr("use one of ao, lobe, sh"))
            << entry.name;
    }
    EXPECT_NE(strand_refusal(map, surfaces, "ao").find("makecfem --kernel strand"), std::string::npos);
    EXPECT_THAT(strand_refusal(map, surfaces, "lobe"), testing::HasSubstr("makecfem --kernel strand --stack"));
    EXPECT_THAT(strand_refusal(map, strands, "lobe"), testing::HasSubstr("makecfem --kernel strand --stack"));
    EXPECT_NE(strand_refusal(map, sky, "sh").find("--basis sh"), std::string::npos);
    // And the other way round.
    OIIO::ImageBuf wall;
    VismapParams params = rays(4);
    params.resolution = { 4, 4 };
    ASSERT_TRUE(make_vismap(wall, scenes::floor_facing_z(1), {}, params));
    EXPECT_NE(strand_refusal(wall, strands, "paper").find("makecfem --kernel cosine"), std::string::npos);
    // What is left is chosen.
    ASSERT_TRUE(make_lightmap(lit, map, strands, model_entry("auto"))) << lit.geterror();
    EXPECT_EQ(lit.spec().get_string_attribute("vmlight:model"), "ao");
    std::vector<OIIO::ImageBuf> stack;
    std::string error;
    ShadingModel chosen;
    ASSERT_TRUE(choose_model(chosen, model_entry("auto"), map_with("sh", crossing(), {}).spec(), true, error)) << error;
    EXPECT_EQ(chosen.name, "sh");
}

// A number that is not finite is reported, wherever it is in a texel.
TEST(StrandLight, NoBadNumberOfATexelGoesUnseenByLobe)
{
    const std::vector<OIIO::ImageBuf> stack = strand_stack(uneven_sky(), 16, 8);
    const OIIO::ImageBuf good = map_with("vector", crossing(), low_floor());
    for (const float bad : { NAN, INFINITY, -INFINITY })
        for (int channel = 0; channel < 7; ++channel) {
            OIIO::ImageBuf map = good, lit;
            float texel[7];
            map.getpixel(3, 1, texel, 7);
            texel[channel] = bad;
            map.setpixel(3, 1, texel, 7);
            EXPECT_FALSE(make_lightmap(lit, map, stack, model_entry("lobe"))) << bad << " in channel " << channel;
            EXPECT_THAT(lit.geterror(), testing::HasSubstr("not finite")) << channel;
        }
}
