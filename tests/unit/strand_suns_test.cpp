// SPDX-License-Identifier: Apache-2.0
// Suns on strands, and all light of maps of strands as the stages make it.
#include "scenes.h"
#include "stage_scene.h"
#include "strand_bake.h"

#include <vmlight/math/latlong.h>
#include <vmlight/stage/make_stage.h>
#include <vmlight/vismap/strand_suns.h>

#include <gmock/gmock.h>

#include <cmath>

using namespace vmlight;
using namespace vmlight::strand_files;

namespace {

constexpr double kNarrow = .25 * latlong::pi / 180;

/// T of the texels of strands, 8 texels each.
std::vector<float> traced(const Strands& strands, const std::vector<Mesh>& occluders, const std::vector<Disc>& discs,
                          int nthreads = 1, VismapParams params = {})
{
    StrandScene scene;
    StrandLayout layout;
    std::string error;
    std::vector<float> seen;
    int64_t rays = -1;
    EXPECT_TRUE(scene.build(strands, occluders, 1, error)) << error;
    EXPECT_TRUE(StrandLayout::make(layout, strands.count(), 8, error)) << error;
    EXPECT_TRUE(trace_strand_discs(seen, strands, scene, layout, discs, params, nthreads, rays));
    EXPECT_EQ(rays, int64_t(strands.count() * 8 * discs.size()) * kStrandDiscRays);
    return seen;
}

Disc disc_along(V3d direction, double half_angle = kNarrow)
{
    return { direction.normalized(), half_angle };
}

const Strands kUpright = straight({ { V3d(0), V3d(0, 1, 0) } }, .01);

/// A wall at x = 1 up to y = high, as good as endless otherwise.
Mesh wall_to(double high)
{
    constexpr double kFar = 1e4;
    return scenes::quad(V3d(1, -kFar, -kFar), V3d(1, high, -kFar), V3d(1, high, kFar), V3d(1, -kFar, kFar));
}

} // namespace

TEST(StrandSuns, AnOpenStrandSeesTheSineOfItsAngle)
{
    for (const double angle : { 90.0, 60.0, 20.0 }) {
        const double radians = angle * latlong::pi / 180;
        const std::vector<float> seen = traced(
            kUpright, {}, { disc_along(V3d(std::sin(radians), std::cos(radians), 0)), disc_along(V3d(0, 0, 1)) });
        ASSERT_EQ(seen.size(), 16u);
        for (size_t i = 0; i < seen.size(); i += 2) {
            EXPECT_NEAR(seen[i], std::sin(radians) / latlong::pi, 2e-4) << angle;
            EXPECT_NEAR(seen[i + 1], 1 / latlong::pi, 1e-5);
        }
    }
}

TEST(StrandSuns, AWallHidesThemOrAPartOfThem)
{
    const double half_angle = 2 * latlong::pi / 180;
    const std::vector<float> seen = traced(kUpright, { wall_to(.5) }, { disc_along(V3d(1, 0, 0), half_angle) });
    // Of 8 texels from 0 to 1 the lower four are in its shade; an edge at the height of a texel hides half.
    for (size_t i = 0; i < 8; ++i)
        EXPECT_NEAR(seen[i], i < 4 ? 0 : 1 / latlong::pi, 2e-4) << i;
    const std::vector<float> edge = traced(kUpright, { wall_to(.3125) }, { disc_along(V3d(1, 0, 0), half_angle) });
    EXPECT_NEAR(edge[2], .5 / latlong::pi, .02);
    VismapParams near;
    near.max_distance = .9;
    EXPECT_NEAR(traced(kUpright, { wall_to(2) }, { disc_along(V3d(1, 0, 0)) }, 1, near)[3], 1 / latlong::pi, 1e-5);
}

TEST(StrandSuns, TheSameBitsForAnyNumberOfThreads)
{
    Strands many = straight(
        { { V3d(0), V3d(0, 1, 0) }, { V3d(.1, 0, 0), V3d(0, 1, .2) }, { V3d(.1, 0, .1), V3d(.3, 1, 0) } }, .02);
    const std::vector<Disc> discs { disc_along(V3d(1, .3, .2), .05), disc_along(V3d(-1, 1, .2)) };
    EXPECT_EQ(traced(many, {}, discs, 1), traced(many, {}, discs, 3));
    EXPECT_TRUE(traced(many, {}, {}).empty());
}

namespace {

class StrandSunStage : public testing::Test
{
protected:
    StrandSunStage()
    {
        folder.write("hair.tfx", tfx(5, 4));
        folder.write("hair.vismap",
                     "mesh = \"hair.tfx\"\nradius = \"0.05:0.01\"\nsamples = 16\nbasis = \"sh\"\n"
                     "occluder = \"spot.obj\"\n");
        light.environment = folder / "sunny.exr";
        light.vismap = folder / "hair.vismap";
        OIIO::ImageBuf sky = split_sky();
        EXPECT_TRUE(sky.write(light.environment)) << sky.geterror();
    }
    // Grey, with a sun of half a degree at its zenith, of irradiance / pi 20.
    static OIIO::ImageBuf split_sky()
    {
        OIIO::ImageBuf sky(OIIO::ImageSpec(512, 256, 3, OIIO::TypeFloat));
        const double top = latlong::row_solid_angle(0, 256);
        for (int y = 0; y < 256; ++y)
            for (int x = 0; x < 512; ++x) {
                const float value = y == 0 ? float(20 * latlong::pi / top) : .5f;
                const float rgb[3] = { value, value, value };
                sky.setpixel(x, y, rgb);
            }
        return sky;
    }
    OIIO::ImageBuf lit(const LightmapRecipe& recipe)
    {
        OIIO::ImageBuf image;
        EXPECT_TRUE(make_image(image, recipe)) << image.geterror();
        return image;
    }
    stage_scene::Folder folder;
    LightmapRecipe light;
};

} // namespace

TEST_F(StrandSunStage, TheModelShTakesTheEnvironmentOfTheRecipe)
{
    EXPECT_EQ(lit(light).spec().get_string_attribute("vmlight:model"), "sh");
}

TEST_F(StrandSunStage, SunsAreTracedOnTheStrandsOfTheMap)
{
    light.suns = "on";
    const OIIO::ImageBuf traced = lit(light);
    EXPECT_EQ(traced.spec().get_string_attribute("vmlight:model"), "sh+suns");
    // Strands of tfx() stand upright under the sun, which their tangents point at: only the rest lights them.
    EXPECT_LT(traced.getchannel(8, 2, 0, 0), .55f);
    light.lightmap_params.rotate = { 90, 0, 0 }; // now it comes from the side
    EXPECT_GT(lit(light).getchannel(8, 2, 0, 0), 20 / latlong::pi * .9);
}

TEST_F(StrandSunStage, AStoredMapIsGivenItsFiles)
{
    VismapRecipe bake;
    std::string error;
    ASSERT_TRUE(read_recipe(bake, folder / "hair.vismap", error)) << error;
    OIIO::ImageBuf map;
    ASSERT_TRUE(make_image(map, bake)) << map.geterror();
    ASSERT_TRUE(map.write(folder / "hair_vismap.exr")) << map.geterror();
    light.suns = "on";
    light.lightmap_params.rotate = { 0, 0, 60 };
    const auto expected = stage_scene::all_pixels(lit(light));
    light.vismap = folder / "hair_vismap.exr";
    light.mesh = folder / "hair.tfx";
    light.occluder = { folder / "spot.obj" };
    EXPECT_EQ(stage_scene::all_pixels(lit(light)), expected);
    const auto refused = [&] {
        OIIO::ImageBuf image;
        EXPECT_FALSE(make_image(image, light));
        return image.geterror();
    };
    light.occluder.clear();
    EXPECT_THAT(refused(), testing::HasSubstr("the map was baked with other occluders: spot.obj; list"));
    light.mesh = folder.write("other.tfx", tfx(5, 3));
    EXPECT_THAT(refused(), testing::HasSubstr("not the strands that the map was baked from"));
    light.mesh.clear();
    EXPECT_THAT(refused(), testing::HasSubstr("does not store its mesh"));
}

TEST_F(StrandSunStage, OtherModelsHaveThemToo)
{
    folder.write("hair.vismap", "mesh = \"hair.tfx\"\nradius = \"0.05:0.01\"\nsamples = 16\n");
    light.suns = "auto";
    EXPECT_EQ(lit(light).spec().get_string_attribute("vmlight:model"), "lobe+suns");
    light.lightmap_params.model = "ao";
    EXPECT_EQ(lit(light).spec().get_string_attribute("vmlight:model"), "ao+suns");
}
