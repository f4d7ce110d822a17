// SPDX-License-Identifier: Apache-2.0
// Suns and bounced light of frames: what lightmaps have of them, and what only frames ask.
#include "scenes.h"
#include "stage_scene.h"
#include "temporary_folder.h"

#include <vmlight/base/work_counts.h>
#include <vmlight/frame/ground.h>
#include <vmlight/frame/lit_object.h>
#include <vmlight/frame/texel_albedo.h>
#include <vmlight/stage/make_stage.h>

#include <OpenImageIO/imagebuf.h>
#include <OpenImageIO/imagebufalgo.h>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

using namespace vmlight;
using Imath::C3f;
using Imath::V2f;
using Imath::V3d;
using OIIO::ImageBuf;
using testing::HasSubstr;

namespace {

// A floor, a red wall to its right as a mesh of its own, and a sky with a sun at 45 degrees above the horizon behind
// the wall.
class FrameLight : public ::testing::Test
{
protected:
    FrameLight()
    {
        m_folder.write("floor.obj",
                       "v -1 0 1\nv 1 0 1\nv 1 0 -1\nv -1 0 -1\nvt 0 0\nvt 1 0\nvt 1 1\nvt 0 1\nvn 0 1 0\n"
                       "f 1/1/1 2/2/1 3/3/1 4/4/1\n");
        m_folder.write("wall.mtl", "newmtl red\nKd 0.8 0.1 0\n");
        m_folder.write("wall.obj",
                       "mtllib wall.mtl\nv 1 0 9\nv 1 0 -9\nv 1 1 -9\nv 1 1 9\nvt 0 0\nvt 1 0\nvt 1 1\nvt 0 1\n"
                       "usemtl red\nf 1/1 2/2 3/3 4/4\n");
        ImageBuf sky(OIIO::ImageSpec(256, 128, 3, OIIO::TypeFloat));
        for (ImageBuf::Iterator<float> pixel(sky); !pixel.done(); ++pixel) {
            const bool is_sun = (pixel.x() == 63 || pixel.x() == 64) && (pixel.y() == 31 || pixel.y() == 32);
            for (int c = 0; c < 3; ++c)
                pixel[c] = is_sun ? 5e3f / float(1 << c) : 1;
        }
        EXPECT_TRUE(sky.write(file("sunny.exr"))) << sky.geterror();
        ImageBuf half(OIIO::ImageSpec(8, 8, 3, OIIO::TypeFloat));
        OIIO::ImageBufAlgo::fill(half, { 0.5f, 0.5f, 0.5f });
        EXPECT_TRUE(half.write(file("half.exr"))) << half.geterror();
        m_trace.suns = "on";
        m_trace.bounce.bounce = "auto";
    }
    std::string file(const std::string& name) const { return m_folder / name; }
    SceneLight sunny(const std::string& suns = "auto")
    {
        SceneLight light;
        CfemRecipe filter;
        filter.stack = true;
        filter.suns = suns;
        filter.cfem_params.resolution = { 64, 32 };
        std::string error;
        EXPECT_TRUE(light.open(file("sunny.exr"), filter, true, {}, error)) << error;
        return light;
    }
    ObjectRecipe recipe(const std::string& mesh) const
    {
        ObjectRecipe result;
        result.map.mesh = file(mesh);
        result.map.vismap_params.resolution = { 64, 64 };
        result.map.vismap_params.samples = 64;
        result.trace = m_trace;
        return result;
    }
    void open(LitObject& dst, const std::string& mesh, const SceneLight& light)
    {
        std::string error;
        ASSERT_TRUE(dst.open(recipe(mesh), {}, error) && dst.read_materials(light.space, "", {}, error)) << error;
    }
    static LightmapParams turned(double degrees) { return turned_light({}, Rotation(), degrees); }
    static std::vector<float> lit(LitObject& object, const SceneLight& light, const LightmapParams& params)
    {
        std::string error;
        EXPECT_TRUE(object.light(light, params, {}, {}, error)) << error;
        return stage_scene::all_pixels(object.lightmaps().at(1001));
    }

    const TemporaryFolder m_folder;
    TraceParams m_trace;
};

float red(const std::vector<float>& pixels, int x, int channel = 0)
{
    return pixels[3 * (32 * 64 + size_t(x)) + size_t(channel)];
}

} // namespace

// Of a map that frames have baked, makelightmap makes the same light, times the albedo, at every rotation.
TEST_F(FrameLight, IsThatOfLightmaps)
{
    const SceneLight light = sunny();
    ASSERT_EQ(light.suns.size(), 1u);
    LitObject floor, wall;
    open(floor, "floor.obj", light);
    open(wall, "wall.obj", light);
    floor.set_occluders({ wall.surface() });
    for (const char* model : { "auto", "paper" })
        for (const double degrees : { 0.0, 25.0, 180.0 }) {
            LightmapParams params = turned(degrees);
            params.model = model;
            const std::vector<float> frame = lit(floor, light, params);
            ASSERT_TRUE(floor.maps().at(1001).write(file("vm.exr")));
            LightmapRecipe lightmap;
            lightmap.vismap = file("vm.exr");
            lightmap.environment = file("sunny.exr");
            lightmap.albedo = file("half.exr"); // what a mesh without colours sends back
            lightmap.mesh = file("floor.obj");
            lightmap.occluder = { file("wall.obj") };
            lightmap.suns = m_trace.suns;
            lightmap.bounce_params = m_trace.bounce;
            lightmap.lightmap_params = params;
            lightmap.cfem_params.resolution = { 64, 32 };
            ImageBuf made;
            ASSERT_TRUE(make_image(made, lightmap)) << made.geterror();
            std::vector<float> twice = stage_scene::all_pixels(made);
            for (float& value : twice)
                value *= 2;
            EXPECT_EQ(frame, twice) << model << " " << degrees;
        }
}

TEST_F(FrameLight, TheWallThrowsItsShadowAndItsColour)
{
    const SceneLight light = sunny();
    LitObject floor, wall;
    open(floor, "floor.obj", light);
    open(wall, "wall.obj", light);
    floor.set_occluders({ wall.surface() });
    const std::vector<float> behind = lit(floor, light, turned(0)), before = lit(floor, light, turned(180));
    // The wall is as high as half the floor is wide.
    EXPECT_LT(red(behind, 36), 2);
    // Its four pixels, 45 degrees high, on a floor that it meets at 45 degrees; the bounce is small that far off.
    const double sun = 5e3 * 4 * std::pow(M_PI / 128, 2) * 0.5 / M_PI;
    EXPECT_NEAR(red(behind, 28) - red(behind, 36), sun, 0.1);
    EXPECT_GT(red(before, 36) - red(behind, 36), sun);
    // Near the sunlit wall there is more red than green, for which the sun has half of it.
    m_trace.bounce.bounce = "off";
    LitObject plain;
    open(plain, "floor.obj", light);
    plain.set_occluders({ wall.surface() });
    const std::vector<float> direct = lit(plain, light, turned(180));
    const double bounced[2] { red(before, 60) - red(direct, 60), red(before, 60, 1) - red(direct, 60, 1) };
    EXPECT_GT(bounced[0], 0.1);
    EXPECT_GT(bounced[0], 8 * bounced[1]);
    EXPECT_NEAR(red(before, 60, 2), red(direct, 60, 2), 1e-6);
    EXPECT_GT(red(before, 60) - red(direct, 60), 2 * (red(before, 3) - red(direct, 3)));
}

// A rotation traces the suns again, and no ray of the bounce.
TEST_F(FrameLight, OtherLightNeedsNoNewRays)
{
    const SceneLight light = sunny();
    LitObject floor, wall;
    open(floor, "floor.obj", light);
    open(wall, "wall.obj", light);
    floor.set_occluders({ wall.surface() });
    const auto first = lit(floor, light, turned(0));
    const int64_t rays = work_counts().bounce_rays, made = work_counts().bounces_made;
    EXPECT_GT(rays, 0);
    EXPECT_NE(lit(floor, light, turned(90)), first);
    EXPECT_EQ(lit(floor, light, turned(0)), first);
    EXPECT_EQ(work_counts().bounce_rays, rays);
    EXPECT_EQ(work_counts().bounces_made, made + 2);
}

// What is not asked for is not traced, and leaves the light as it was.
TEST_F(FrameLight, NothingAskedNothingTraced)
{
    m_trace = {};
    const SceneLight light = sunny("off");
    EXPECT_TRUE(light.suns.empty());
    LitObject floor;
    open(floor, "floor.obj", light);
    const int64_t rays = work_counts().bounce_rays;
    const std::vector<float> whole = lit(floor, light, turned(30));
    EXPECT_EQ(work_counts().bounce_rays, rays);
    ImageBuf lightmap;
    ASSERT_TRUE(make_lightmap(lightmap, floor.maps().at(1001), light.filtered, turned(30)));
    EXPECT_EQ(stage_scene::all_pixels(lightmap), whole);
}

TEST_F(FrameLight, MapsWithNormalMapsAreNotTracedOn)
{
    OIIO::ImageSpec map(8, 8, 4, OIIO::TypeFloat);
    EXPECT_EQ(untraceable_reason(map), "");
    map.attribute("vmlight:normal_map", "bumps.png");
    EXPECT_THAT(untraceable_reason(map), HasSubstr("normal map"));
    OIIO::ImageSpec part(8, 8, 4, OIIO::TypeFloat);
    part.full_width = 16;
    EXPECT_THAT(untraceable_reason(part), HasSubstr("only a part"));

    ImageBuf bumpy(map);
    OIIO::ImageBufAlgo::zero(bumpy);
    bumpy.specmod().channelnames = { "visibility", "direction.x", "direction.y", "direction.z" };
    ASSERT_TRUE(bumpy.write(file("bumpy.exr")));
    std::string error, warned;
    MakeOptions options;
    options.warn = [&](const std::string& line) { warned = line; };
    TraceParams trace;
    trace.suns = "auto";
    ASSERT_TRUE(choose_trace(trace, file("bumpy.exr"), options, error)) << error;
    EXPECT_EQ(trace.suns, "off");
    EXPECT_THAT(warned, HasSubstr("suns stay in the environment"));
    trace.suns = "on";
    EXPECT_FALSE(choose_trace(trace, file("bumpy.exr"), options, error));
    EXPECT_THAT(error, HasSubstr("bumpy.exr\": the visibility map was baked with a normal map"));
    EXPECT_TRUE(choose_trace(trace, "", options, error));
}

// The ground's light where nothing is in its way, which its shadows are measured against: of the sun
// E sin(elevation) / pi, and half of that of a small sun that the horizon halves.
TEST_F(FrameLight, AnOpenGroundHasTheSunsOfItsSky)
{
    Subject subject;
    subject.add(scenes::box(V3d(-1), V3d(1), false));
    const auto ground = make_ground_mesh(subject, Rotation(), "");
    SceneLight light;
    light.filtered.emplace_back(OIIO::ImageSpec(16, 8, 3, OIIO::TypeFloat));
    OIIO::ImageBufAlgo::fill(light.filtered[0], { 1, 2, 6 });
    const double half = 0.02;
    for (const double elevation : { 90.0, 30.0, 0.0, -30.0 }) {
        const double e = elevation * M_PI / 180;
        light.suns = { { { V3d(std::cos(e), std::sin(e), 0), half }, { 3, 3, 3 } } };
        // Of a disc that the horizon halves, the mean height above it is that of a half disc: 4 a / 3 pi, of half.
        const double seen = elevation > 0 ? std::sin(e) : elevation == 0 ? 0.5 * 4 * half / (3 * M_PI) : 0;
        float unshadowed = 0;
        std::string error;
        ASSERT_TRUE(find_unshadowed(unshadowed, *ground, light, {}, error)) << error;
        EXPECT_NEAR(unshadowed, 3 + 3 * seen, 2e-3 * seen + 1e-5) << elevation;
    }
}

// A texture of the map's size and UVs keeps its texels; around it they are those of its border.
TEST_F(FrameLight, AlbedoIsThatOfTheMaterials)
{
    constexpr int kSide = 16;
    Mesh mesh;
    scenes::add_quad(mesh, V3d(-1, -1, 0), V3d(1, -1, 0), V3d(1, 1, 0), V3d(-1, 1, 0), V2f(0, 0), V2f(0.5f, 1));
    scenes::add_quad(mesh, V3d(-1, -1, -1), V3d(1, -1, -1), V3d(1, 1, -1), V3d(-1, 1, -1), V2f(0.75f, 0),
                     V2f(0.875f, 1));
    mesh.triangle_materials = { 0, 0, 1, 1 };
    VismapParams params;
    params.resolution = { kSide, kSide };
    params.samples = 4;
    ImageBuf map;
    ASSERT_TRUE(make_vismap(map, mesh, {}, params));
    std::vector<float> rgba;
    for (int i = 0; i < 4 * kSide * kSide; ++i)
        rgba.push_back(float(i * 7919 % 1009) / 1009);
    FrameSurface surface;
    surface.mesh = std::make_shared<const Mesh>(mesh);
    surface.materials.resize(2);
    surface.materials[0].color = C3f(1, 0.5f, 1);
    surface.materials[0].texture = std::make_shared<TexturePyramid>(kSide, kSide, 4, rgba.data(), nullptr);
    const ImageBuf albedo = texel_albedo(surface, map, 1001, 0.25f, 1);
    for (int y = 0; y < kSide; ++y)
        for (int x = 0; x < kSide; ++x) {
            const float* texel = static_cast<const float*>(albedo.pixeladdr(x, y));
            const float* painted = &rgba[size_t(4 * (y * kSide + x))];
            if (x < kSide / 2) {
                EXPECT_NEAR(texel[0], painted[0], 1e-5) << x << " " << y;
                EXPECT_NEAR(texel[1], 0.5f * painted[1], 1e-5) << x << " " << y;
            } else if (x >= 3 * kSide / 4 - 1) { // white says nothing; and around it
                EXPECT_EQ(texel[2], 0.25f) << x << " " << y;
            }
        }
}
