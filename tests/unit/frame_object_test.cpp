// SPDX-License-Identifier: Apache-2.0
// Objects of frames: what they read, make and keep, and where nothing of them is.
#include "scenes.h"
#include "temporary_folder.h"

#include <vmlight/frame/ground.h>
#include <vmlight/frame/lit_object.h>
#include <vmlight/frame/pixel_cover.h>
#include <vmlight/frame/surface_materials.h>
#include <vmlight/frame/texel_weights.h>
#include <vmlight/image/channels.h>

#include <OpenImageIO/imagebuf.h>
#include <OpenImageIO/imagebufalgo.h>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

using namespace vmlight;
using Imath::V2f;
using Imath::V3d;
using OIIO::ImageBuf;
using testing::HasSubstr;

namespace {

std::shared_ptr<const Mesh> held(Mesh mesh)
{
    return std::make_shared<const Mesh>(std::move(mesh));
}

SceneLight constant_light(const std::vector<float>& color)
{
    SceneLight light;
    light.filtered.emplace_back(OIIO::ImageSpec(16, 8, 3, OIIO::TypeFloat));
    OIIO::ImageBufAlgo::fill(light.filtered[0], color);
    return light;
}

VismapParams object_map_params(int side, int samples = 64)
{
    VismapParams params;
    params.resolution = { side, side };
    params.samples = samples;
    return params;
}

LightmapParams with_model(const std::string& name)
{
    LightmapParams params;
    params.model = name;
    return params;
}

} // namespace

TEST(PixelCover, NothingThatIsSeenIsMissed)
{
    FrameScene scene;
    scene.surfaces.resize(1);
    scene.surfaces[0].mesh = held(scenes::icosphere(1));
    std::string error;
    ASSERT_TRUE(scene.build(1, error)) << error;
    for (const bool is_orthographic : { true, false }) {
        Camera camera;
        camera.position = V3d(0.3, 0.2, 4);
        camera.is_orthographic = is_orthographic;
        camera.half_width = camera.half_height = is_orthographic ? 2 : 0.5;
        const int side = 40;
        const PixelCover cover(scene, camera, { side, side }, 0, 3);
        int empty = 0;
        for (int y = 0; y < side; ++y)
            for (int x = 0; x < side; ++x) {
                empty += cover.is_empty(x, y);
                for (int k = 0; k < 9; ++k) {
                    const CameraRay ray = camera.ray(x + (k % 3 + 0.5) / 3, y + (k / 3 + 0.5) / 3, side, side);
                    const SurfaceRay line { ray.origin, ray.direction, 0 };
                    SurfaceHit hit;
                    scene.tracer->find(&line, 1, &hit);
                    EXPECT_FALSE(hit.exists() && cover.is_empty(x, y)) << x << " " << y;
                }
            }
        EXPECT_GT(empty, side * side / 4); // the corners of the picture
        EXPECT_TRUE(cover.is_empty(0, 0, 3, 3));
        EXPECT_FALSE(cover.is_empty(0, 0, side, side));
    }
}

TEST(PixelCover, WhatIsAroundTheCameraIsEverywhere)
{
    FrameScene scene;
    scene.surfaces.resize(1);
    scene.surfaces[0].mesh = held(scenes::box(V3d(-1), V3d(1), true));
    std::string error;
    ASSERT_TRUE(scene.build(1, error)) << error;
    Camera camera;
    camera.position = V3d(0);
    const PixelCover cover(scene, camera, { 8, 8 }, 0, 1);
    for (int i = 0; i < 64; ++i)
        EXPECT_FALSE(cover.is_empty(i % 8, i / 8));
}

TEST(TexelWeights, CoverIsOneAndTheMarginAlmostNothing)
{
    Mesh mesh;
    scenes::add_quad(mesh, V3d(-1, -1, 0), V3d(1, -1, 0), V3d(1, 1, 0), V3d(-1, 1, 0), V2f(0.25f, 0.25f),
                     V2f(0.75f, 0.75f));
    VismapParams params = object_map_params(32, 4);
    params.margin = 4;
    ImageBuf map;
    ASSERT_TRUE(make_vismap(map, mesh, {}, params));
    const std::vector<float> weights = texel_weights(mesh, map, 1001, 1);
    const auto at = [&](int x, int y) { return weights[size_t(y * 32 + x)]; };
    EXPECT_EQ(at(16, 16), 1);
    EXPECT_EQ(at(8, 8), 1);
    EXPECT_GT(at(6, 16), 0);
    EXPECT_LT(at(6, 16), 1e-5f);
    EXPECT_EQ(at(1, 16), 0);
}

// Below a roof that covers the sky from horizon to horizon there is no light; beside it there is all of it.
TEST(LitObject, OccludersAreInItsWay)
{
    LitObject open, covered;
    const auto floor = held(scenes::floor_facing_z(1));
    open.open(floor, object_map_params(16));
    covered.open(floor, object_map_params(16));
    FrameSurface roof;
    roof.mesh = held(scenes::floor_facing_z(1e5, V3d(0, 0, 0.01)));
    covered.set_occluders({ roof });
    std::string error, used;
    const SceneLight light = constant_light({ 1, 2, 3 });
    ASSERT_TRUE(open.light(light, with_model("paper"), {}, {}, error, &used)) << error;
    EXPECT_EQ(used, "paper");
    ASSERT_TRUE(covered.light(light, with_model("paper"), {}, {}, error)) << error;
    float seen[3], hidden[3];
    ASSERT_TRUE(open.surface().light->lookup({ Imath::V2d(0.5, 0.5) }, seen, error));
    ASSERT_TRUE(covered.surface().light->lookup({ Imath::V2d(0.5, 0.5) }, hidden, error));
    EXPECT_NEAR(seen[2], 3, 1e-5);
    EXPECT_LT(hidden[2], 0.02);
}

// Each basis is baked once, whatever is asked of it, and kept when another is asked for.
TEST(LitObject, MapsAreBakedForTheirModels)
{
    LitObject object;
    object.open(held(scenes::sphere(V3d(0), 1, 8)), object_map_params(16, 4));
    int bakes = 0;
    MakeOptions options;
    options.say = [&](const std::string& line) { bakes += line.compare(0, 5, "bake:") == 0; };
    std::string error, used;
    const SceneLight light = constant_light({ 1, 1, 1 });
    for (const char* name : { "paper", "ao", "paper", "lobe" })
        object.light(light, with_model(name), {}, options, error); // `lobe` lacks a stack, but not a map
    EXPECT_EQ(bakes, 1);
    error.clear();
    EXPECT_FALSE(object.light(light, with_model("sh"), {}, options, error));
    EXPECT_EQ(bakes, 2);
    EXPECT_EQ(object.maps().at(1001).spec().get_string_attribute("vmlight:basis"), "sh");
}

TEST(LitObject, MeshesWithoutUsableUvsAreUnwrapped)
{
    const TemporaryFolder folder;
    const std::string bare = folder.write("bare.obj", "v 0 0 0\nv 1 0 0\nv 1 1 0\nf 1 2 3\n");
    // Two triangles apart in space, on top of each other in UV.
    const std::string twice
        = folder.write("twice.obj",
                       "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 0 5\nv 1 0 5\nv 1 1 5\nvt 0 0\nvt 1 0\nvt 1 1\nf 1/1 2/2 3/3\n"
                       "f 4/1 5/2 6/3\n");
    const std::string good
        = folder.write("good.obj", "v 0 0 0\nv 1 0 0\nv 1 1 0\nvt 0 0\nvt 1 0\nvt 1 1\nf 1/1 2/2 3/3\n");
    for (const auto& [path, reason] :
         { std::pair(bare, "no UVs; "), std::pair(twice, "its UVs overlap; "), std::pair(good, "") }) {
        std::string said, error;
        MakeOptions options;
        options.say = [&](const std::string& line) { said += line; };
        LitObject object;
        ObjectRecipe recipe;
        recipe.map.mesh = path;
        recipe.map.vismap_params = object_map_params(64);
        ASSERT_TRUE(object.open(recipe, options, error)) << error;
        EXPECT_EQ(object.is_unwrapped(), *reason != 0) << path;
        EXPECT_THAT(said, HasSubstr(reason));
        EXPECT_FALSE(object.mesh().uvs.empty());
    }
}

TEST(Ground, LiesUnderTheObjectsWhateverTheirPose)
{
    const Mesh box = scenes::box(V3d(-1, -2, -3), V3d(1, 2, 3), false);
    for (const Rotation& pose : { Rotation(), rotation_from_angles(30, 40, 50) }) {
        Subject subject;
        subject.add(box, pose);
        const auto ground = make_ground_mesh(subject, pose, "");
        for (const V3d& corner : ground->positions) {
            const V3d level = rotate(pose, corner);
            EXPECT_LT(level.y, subject.low().y);
            EXPECT_NEAR(level.y, subject.low().y, 2e-4 * subject.radius());
        }
        const V3d up = rotate(pose, V3d(ground->normals[0]));
        EXPECT_NEAR(up.y, 1, 1e-6);
        const V3d a = ground->positions[1] - ground->positions[0], b = ground->positions[2] - ground->positions[0];
        EXPECT_GT(a.cross(b).dot(V3d(ground->normals[0])), 0); // it faces up
        // In light of one colour it is that colour where nothing is in the way.
        float unshadowed = 0;
        std::string error;
        ASSERT_TRUE(find_unshadowed(unshadowed, *ground, constant_light({ 1, 2, 6 }), {}, error)) << error;
        EXPECT_NEAR(unshadowed, 3, 1e-5);
    }
}

TEST(SurfaceMaterials, ColoursAreBroughtToTheSpaceOfTheLight)
{
    const TemporaryFolder folder;
    OIIO::ImageSpec spec(2, 2, 4, OIIO::TypeUInt8);
    ImageBuf image(spec);
    OIIO::ImageBufAlgo::fill(image, { 0.5f, 0.5f, 0.5f, 0.25f });
    image.specmod().attribute("oiio:UnassociatedAlpha", 1);
    ASSERT_TRUE(image.write(folder / "gray.png"));
    Mesh mesh;
    mesh.materials.resize(3);
    mesh.materials[0].base_color = { 0.2f, 0.4f, 0.8f, 0.5f };
    mesh.materials[0].alpha_mode = AlphaMode::blend;
    mesh.materials[1].base_color_texture.path = folder / "gray.png";
    mesh.materials[2].base_color_texture.path = folder / "none.png";
    std::vector<std::string> warnings;
    MakeOptions options;
    options.warn = [&](const std::string& line) { warnings.push_back(line); };
    std::vector<SurfaceMaterial> materials;
    std::string error;
    ASSERT_TRUE(read_materials(materials, mesh, "lin_rec709_scene", "", options, error)) << error;
    ASSERT_EQ(materials.size(), 3u);
    EXPECT_FLOAT_EQ(materials[0].color.y, 0.4f);
    EXPECT_EQ(materials[0].alpha, 0.5f);
    EXPECT_EQ(materials[0].alpha_mode, AlphaMode::blend);
    ASSERT_TRUE(materials[1].texture);
    float rgba[4];
    materials[1].texture->lookup({ Imath::V2d(0.5, 0.5) }, rgba);
    EXPECT_NEAR(rgba[0], 0.2158, 3e-3); // sRGB 0.5 is linear 0.214; 128 / 255 is .2158
    EXPECT_NEAR(rgba[3], 0.25, 3e-3);
    EXPECT_FALSE(materials[2].texture);
    ASSERT_EQ(warnings.size(), 1u);
    EXPECT_THAT(warnings[0], HasSubstr("none.png"));
    // A config's working space: ACEScg's green of a Rec.709 green is not 1.
    mesh.materials[0].base_color = { 0, 1, 0, 1 };
    ASSERT_TRUE(read_materials(materials, mesh, "lin_ap1_scene", VMLIGHT_TEST_OCIO, options, error)) << error;
    EXPECT_NEAR(materials[0].color.x, 0.3395, 1e-3);
    EXPECT_NEAR(materials[0].color.y, 0.9164, 1e-3);
}
