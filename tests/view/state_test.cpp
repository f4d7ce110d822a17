// SPDX-License-Identifier: Apache-2.0
// What vmview keeps and says, without a window: settings, the copied command, the texel under the cursor.
#include "view_test.h"

#include "strand_files.h"
#include "temporary_folder.h"
#include "vmview/scene/loading.h"
#include "vmview/settings.h"
#include "vmview/ui/copied_command.h"
#include "vmview/ui/cursor.h"
#include "vmview/ui/view_state.h"

#include <memory>
#include <string>
#include <vector>

using namespace vmlight;
using namespace vmlight::view;
using namespace vmlight::strand_files;

TEST(Settings, ComeBack)
{
    const TemporaryFolder folder;
    Settings settings;
    settings.window = { 900, 600 };
    settings.model = "paper";
    settings.view = "ACES 1.0 - SDR Video";
    remember_file(settings.recent_mesh, "/a/hero = 2.obj");
    remember_file(settings.recent_mesh, "/a/other.obj");
    remember_file(settings.recent_mesh, "/a/./hero = 2.obj");
    const std::string path = folder / "deep/er/vmview.conf";
    std::string error;
    ASSERT_TRUE(write_settings(settings, path, error)) << error;
    const Settings again = read_settings(path);
    EXPECT_EQ(again.window.width, 900);
    EXPECT_EQ(again.model, "paper");
    EXPECT_EQ(again.view, "ACES 1.0 - SDR Video");
    EXPECT_EQ(again.recent_mesh, (std::vector<std::string> { "/a/hero = 2.obj", "/a/other.obj" }));
}

TEST(Settings, WhatCannotBeReadIsDefault)
{
    const TemporaryFolder folder;
    const std::string path = folder.write("vmview.conf", "window = a lot\nnonsense\nmodel = lobe\n\x01\x02 = 3\n");
    const Settings settings = read_settings(path);
    EXPECT_EQ(settings.window.width, 1280);
    EXPECT_EQ(settings.model, "lobe");
    EXPECT_EQ(read_settings(folder / "none").model, "auto");
}

TEST(CopiedCommand, SaysWhatIsSeen)
{
    Request request;
    request.mesh.mesh = "/a/my hero.obj";
    request.environment = "sky.hdr";
    ViewState state = state_of(request);
    EXPECT_EQ(makelightmap_command(request, state, "sh"),
              "makelightmap 'my hero_vismap.exr' sky.hdr --model sh -o 'my hero_lit.exr'");
    turn_object(state, 60, 0);
    turn_environment(state, -20);
    state.light.exposure = 1.5;
    state.camera.elevation = 20;
    EXPECT_EQ(makelightmap_command(request, state, ""),
              "makelightmap 'my hero_vismap.exr' sky.hdr --rotate 0,30,0 --env-rotate 0,-10,0 --exposure 1.5 -o 'my "
              "hero_lit.exr'");
    state.second = "reference";
    EXPECT_EQ(vmframes_command(request, state, "lobe"),
              "vmframes '/a/my hero.obj' sky.hdr --rotate 0,30,0 --env-rotate 0,-10,0 --exposure 1.5 --wipe "
              "lobe,reference --elevation 20 -o 'my hero.png'");
    EXPECT_EQ(shell_word("it's"), "'it'\\''s'");
}

TEST(CopiedCommand, HasTheStrands)
{
    Request request;
    request.mesh.mesh = "body.obj";
    request.environment = "sky.hdr";
    request.view.object = { "the hair.tfx" };
    request.view.strand_color = { 0.5, 0.25, 0 };
    request.mesh.strand_params.radius = "0.004:0.001";
    request.mesh.strand_params.strand_texels = 8;
    request.specular = { 0.1, 60 };
    ViewState state = state_of(request);
    EXPECT_EQ(vmframes_command(request, state, ""),
              "vmframes body.obj sky.hdr --object 'the hair.tfx' --radius 0.004:0.001 --strand-texels 8 --strand-color "
              "0.5,0.25,0 --strand-specular 0.1 --strand-exponent 60 -o body.png");
    state.is_white = true; // which vmframes refuses a colour with
    EXPECT_EQ(
        vmframes_command(request, state, ""),
        "vmframes body.obj sky.hdr --object 'the hair.tfx' --radius 0.004:0.001 --strand-texels 8 --strand-specular "
        "0.1 --strand-exponent 60 --white -o body.png");
}

TEST(CopiedCommand, HasCameraColorAndTracedLight)
{
    Request request;
    request.mesh.mesh = "hero.obj";
    request.environment = "sky.hdr";
    request.vismap = "hero_vm.exr";
    request.filter.colorconfig = "show.ocio";
    request.filter.colorspace = "ACEScg";
    ViewState state = state_of(request);
    state.trace.suns = "auto";
    state.trace.bounce.bounce = "on";
    state.trace.bounce.bounce_rays = 99;
    state.trace.bounce.bounce_albedo = 0.25;
    state.camera.azimuth = 30;
    state.camera.fov = 60;
    state.camera.fill = 0.5;
    state.camera.look_at = { 1, 2, 3 };
    state.display = { "sRGB", "Film", "warm" };
    EXPECT_EQ(makelightmap_command(request, state, "paper"),
              "makelightmap hero_vm.exr sky.hdr --model paper --colorconfig show.ocio --colorspace ACEScg --suns auto "
              "--mesh hero.obj -o hero_lit.exr");
    const std::string begin = "vmframes hero.obj sky.hdr --vismap hero_vm.exr --model paper --colorconfig show.ocio "
                              "--colorspace ACEScg --suns auto --bounce on --bounce-rays 99 --bounce-albedo 0.25 ",
                      end = "--display sRGB --view Film --look warm -o hero.png";
    EXPECT_EQ(vmframes_command(request, state, "paper"),
              begin + "--azimuth 30 --fov 60 --fill 0.5 --look-at 1,2,3 " + end);
    state.camera.camera = "shot cam"; // of the mesh's file, which says all of it
    state.has_background = true;
    EXPECT_EQ(vmframes_command(request, state, "paper"), begin + "--camera 'shot cam' --background environment " + end);
}

// The copied rotation is the one that the view lights with.
TEST(CopiedCommand, RotationIsThatOfTheLight)
{
    ViewState state;
    state.light.rotate = { 20, 30, 40 };
    state.turn = 25;
    const std::string line = makelightmap_command({}, state, "");
    const size_t begin = line.find("--matrix ") + 9;
    LightmapParams copied, seen;
    std::string error;
    ASSERT_TRUE(set_param(copied, "matrix", line.substr(begin, line.find(' ', begin) - begin), error)) << error;
    ASSERT_TRUE(light_params(seen, state.light, state.turn, error)) << error;
    for (size_t i = 0; i < 9; ++i)
        EXPECT_NEAR(copied.matrix[i], seen.matrix[i], 1e-9);
}

TEST(Cursor, FindsTheTexel)
{
    auto mesh = std::make_shared<MeshAsset>();
    const auto triangles = std::make_shared<Mesh>(square());
    BakeScene scene;
    std::string error;
    ASSERT_TRUE(scene.build(triangles, {}, 1, error)
                && mesh->surface.build({ triangles.get() }, scene.frame(), 1, error))
        << error;
    mesh->mesh = triangles;
    mesh->subject.add(*triangles);
    MapAsset map;
    map.image = full_map(*triangles, { 8, 8 });
    CameraParams straight;
    straight.elevation = 0;
    straight.fov = 0;
    straight.fill = 1;
    const Camera camera = place_camera(straight, mesh->subject, 1, false);
    const CursorTexel texel = texel_under(*mesh, &map, camera, 25, 5, 80, 80);
    EXPECT_TRUE(texel.has_texel);
    EXPECT_EQ(texel.x, 2);
    EXPECT_EQ(texel.y, 0);
    EXPECT_EQ(describe_texel(map, texel.x, texel.y), "V 1.0000\nB 0.0000 0.0000 0.6667\n|B| / V 0.6667");
    EXPECT_FALSE(texel_under(*mesh, &map, camera, 100, 5, 80, 80).is_on_mesh);
}

// The third of four texels of the right one of two upright strands; and of the same beside a mesh, in front of it.
TEST(Cursor, FindsTheStrand)
{
    const TemporaryFolder folder;
    MeshRequest request;
    request.recipe.mesh = folder.write(
        "pair.tfx", tfx_of(straight({ { V3d(-1, -1, 4), V3d(-1, 1, 4) }, { V3d(1, -1, 4), V3d(1, 1, 4) } }, 1, 5)));
    request.recipe.strand_params = { "0.1", 4 };
    request.recipe.vismap_params.samples = 4;
    CameraParams straight_on;
    straight_on.elevation = 0;
    straight_on.fov = 0;
    straight_on.fill = 1;
    const std::string strands = request.recipe.mesh;
    for (const bool is_beside : { false, true }) {
        if (is_beside) {
            request.beside = { strands };
            request.recipe.mesh = data_path("cases/box.obj");
            request.recipe.vismap_params.resolution = { 16, 16 };
        }
        std::string error;
        const MeshPointer mesh = read_mesh_asset(request, false, "", "", {}, error);
        ASSERT_TRUE(mesh) << error;
        const MapPointer map = bake_map(*mesh, "auto", 4, {}, error);
        ASSERT_TRUE(map) << error;
        // Two units wide and high, from (-1, 1) down.
        Camera camera = place_camera(straight_on, mesh->subject, 1, false);
        camera.position = V3d(0, 0, 10);
        camera.half_width = camera.half_height = 1;
        const CursorTexel texel = texel_under(*mesh, map.get(), camera, 79, 25, 80, 80);
        EXPECT_TRUE(texel.is_on_strand && texel.has_texel) << is_beside;
        EXPECT_EQ(texel.figure, is_beside ? 1u : 0u);
        EXPECT_EQ(texel.strand, 1);
        EXPECT_EQ(texel.x, 2);
        EXPECT_EQ(texel.y, 1);
    }
}

// The near side of the object follows the mouse.
TEST(ViewState, ObjectTurnsWithTheMouse)
{
    const Mesh mesh = square();
    Subject subject;
    subject.add(mesh);
    ViewState state;
    state.camera.elevation = 0;
    turn_object(state, 40, 0);
    const Camera camera = camera_of(state, mesh, subject, 1.5);
    const Imath::V3d near_side(0, 0, 0.1);
    EXPECT_GT((near_side - camera.position).dot(camera.right), 0);
    // At one distance, whatever the angle.
    const double distance = (camera.position - subject.centre()).length();
    turn_object(state, 77, 33);
    EXPECT_NEAR((camera_of(state, mesh, subject, 1.5).position - subject.centre()).length(), distance, 1e-9);
    state.turn = 175;
    turn_object(state, 20, 0);
    EXPECT_EQ(state.turn, -175);
}

// Around what is looked at, at one distance; without perspective, as large.
TEST(ViewState, CameraTurnsAroundWhatItLooksAt)
{
    const Mesh mesh = square();
    Subject subject;
    subject.add(mesh);
    ViewState state;
    state.camera.look_at = { 0.25, -0.5, 0.125 };
    const Imath::V3d target(0.25, -0.5, 0.125);
    for (const double fov : { 40.0, 0.0 }) {
        state.camera.fov = fov;
        state.camera.azimuth = state.camera.elevation = 0;
        const Camera before = camera_of(state, mesh, subject, 1.5);
        EXPECT_EQ(before.is_orthographic, fov == 0);
        turn_camera(state, 30, -40);
        EXPECT_EQ(state.camera.azimuth, -15);
        EXPECT_EQ(state.camera.elevation, -20);
        const Camera after = camera_of(state, mesh, subject, 1.5);
        for (const Camera& camera : { before, after })
            EXPECT_LT((target - camera.position).cross(camera.forward).length(), 1e-9);
        EXPECT_NEAR((target - after.position).length(), (target - before.position).length(), 1e-9);
        EXPECT_EQ(after.half_width, before.half_width);
        EXPECT_NEAR(after.half_width, 1.5 * after.half_height, 1e-12);
    }
    turn_camera(state, 0, 1e4);
    EXPECT_EQ(state.camera.elevation, 90);
}
