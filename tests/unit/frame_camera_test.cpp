// SPDX-License-Identifier: Apache-2.0
// Cameras of frames: where they stand, what they show, and which rays go through a picture.
#include "mesh_fixture.h"
#include "scenes.h"

#include <vmlight/frame/camera.h>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

using namespace vmlight;
using namespace mesh_files;
using Imath::V2d;

namespace {

Subject subject_of(const Mesh& mesh, const Rotation& pose = {})
{
    Subject subject;
    subject.add(mesh, pose);
    return subject;
}

Mesh cube()
{
    return scenes::box(V3d(-1), V3d(1), false);
}

// Where a point is in a picture of 2 x 2, from -1 to 1, y up.
V2d shown(const Camera& camera, const V3d& point)
{
    const V3d q = point - camera.position;
    const double depth = camera.is_orthographic ? 1 : q.dot(camera.forward);
    return { q.dot(camera.right) / (depth * camera.half_width), q.dot(camera.up) / (depth * camera.half_height) };
}

// The farthest that a vertex is from the picture's middle: 1 is on its border.
double reach(const Camera& camera, const Mesh& mesh)
{
    double farthest = 0;
    for (const V3d& position : mesh.positions) {
        const V2d at = shown(camera, position);
        farthest = std::max({ farthest, std::abs(at.x), std::abs(at.y) });
    }
    return farthest;
}

void expect_vector(const V3d& a, const V3d& b, double tolerance = 1e-12)
{
    EXPECT_LE((a - b).length(), tolerance) << a << " " << b;
}

using Cameras = MeshFiles;

} // namespace

TEST(Camera, AzimuthGoesFromTheFrontToTheRight)
{
    CameraParams params;
    params.elevation = 0;
    for (const auto& [azimuth, from] : { std::pair(0.0, V3d(0, 0, 1)), std::pair(90.0, V3d(1, 0, 0)),
                                         std::pair(180.0, V3d(0, 0, -1)), std::pair(-90.0, V3d(-1, 0, 0)) }) {
        params.azimuth = azimuth;
        const Camera camera = place_camera(params, subject_of(cube()), 1, false);
        expect_vector(camera.position.normalized(), from);
        expect_vector(camera.forward, -from);
        expect_vector(camera.up, V3d(0, 1, 0));
        expect_vector(camera.right, camera.forward.cross(camera.up));
    }
    params.azimuth = 0;
    params.elevation = 90;
    const Camera above = place_camera(params, subject_of(cube()), 1, false);
    expect_vector(above.forward, V3d(0, -1, 0));
    expect_vector(above.up, V3d(0, 0, -1));
}

TEST(Camera, TheObjectFillsThePictureAndNoMore)
{
    for (const double fov : { 0.0, 10.0, 35.0, 100.0 })
        for (const double aspect : { 0.5, 1.0, 2.0 })
            for (const double azimuth : { 0.0, 33.0 })
                for (const double fill : { 0.5, 0.9 }) {
                    CameraParams params;
                    params.fov = fov;
                    params.azimuth = azimuth;
                    params.elevation = 20;
                    params.fill = fill;
                    const Camera camera = place_camera(params, subject_of(cube()), aspect, false);
                    EXPECT_NEAR(reach(camera, cube()), fill, 1e-9) << fov << " " << aspect;
                    EXPECT_NEAR(camera.half_width / camera.half_height, aspect, 1e-12);
                }
}

// A cube of side 2 from the front, at 90 degrees: its front face, at z = 1, is as wide as it is far.
TEST(Camera, TheDistanceOfACubeIsTheClosedForm)
{
    CameraParams params;
    params.elevation = 0;
    params.fov = 90;
    params.fill = 1;
    expect_vector(place_camera(params, subject_of(cube()), 1, false).position, V3d(0, 0, 2), 1e-9);
}

TEST(Camera, WhatTurnsFitsInEveryPosition)
{
    const Mesh beam = scenes::box(V3d(-3, -0.2, -0.5), V3d(3, 0.3, 0.5), false);
    CameraParams params;
    params.elevation = 25;
    const Camera camera = place_camera(params, subject_of(beam), 1.5, true);
    double largest = 0;
    for (int degrees = 0; degrees < 360; degrees += 5)
        largest = std::max(largest, reach(turned(camera, degrees, subject_of(beam).centre()), beam));
    EXPECT_LE(largest, params.fill * (1 + 1e-9));
    EXPECT_GE(largest, 0.95 * params.fill); // and is not needlessly small
}

TEST(Camera, TurningTheObjectTurnsTheCameraTheOtherWay)
{
    CameraParams params;
    const Subject subject = subject_of(cube());
    const Camera front = turned(place_camera(params, subject, 1, true), 30, subject.centre());
    params.azimuth = -30;
    expect_vector(front.position, place_camera(params, subject, 1, true).position, 1e-9);
    // The corner that was seen to the front left comes nearer to the right: counter-clockwise from above.
    const V2d before = shown(place_camera({}, subject, 1, false), V3d(0, 0, 1)), after = shown(front, V3d(0, 0, 1));
    EXPECT_GT(after.x, before.x);
}

TEST(Camera, APoseTurnsTheObjectBeforeTheCamera)
{
    const Mesh beam = scenes::box(V3d(-3, -0.2, -0.5), V3d(3, 0.3, 0.5), false);
    const Rotation pose = rotation_from_angles(20, 30, 40);
    const Camera world = place_camera({}, subject_of(beam, pose), 1, false);
    const Camera own = camera_for(world, pose);
    for (const V3d& position : beam.positions) {
        const V2d a = shown(world, rotate(pose, position)), b = shown(own, position);
        EXPECT_NEAR(a.x, b.x, 1e-9);
        EXPECT_NEAR(a.y, b.y, 1e-9);
    }
}

TEST(Camera, PointsAndNothingAtAllHaveACamera)
{
    Mesh point = scenes::floor_facing_z(0);
    for (const double fov : { 0.0, 30.0 }) {
        CameraParams params;
        params.fov = fov;
        for (const Subject& subject : { subject_of(point), Subject() }) {
            if (subject.is_empty())
                params.look_at = { 0, 0, 0 };
            const Camera camera = place_camera(params, subject, 1, true);
            EXPECT_TRUE(std::isfinite(camera.position.length())) << fov;
            EXPECT_GT(camera.half_height, 0);
        }
    }
}

TEST(Camera, RaysGoThroughThePicture)
{
    Camera camera;
    camera.half_width = 2;
    camera.half_height = 1;
    const CameraRay middle = camera.ray(20, 10, 40, 20), corner = camera.ray(0, 0, 40, 20);
    expect_vector(middle.direction, V3d(0, 0, -1));
    expect_vector(corner.direction, V3d(-2, 1, -1));
    expect_vector(camera.ray(21, 10, 40, 20).direction - middle.direction, middle.direction_dx);
    expect_vector(camera.ray(20, 11, 40, 20).direction - middle.direction, middle.direction_dy);
    camera.is_orthographic = true;
    const CameraRay flat = camera.ray(0, 0, 40, 20);
    expect_vector(flat.direction, V3d(0, 0, -1));
    expect_vector(flat.origin, V3d(-2, 1, 1));
    expect_vector(flat.origin_dx, V3d(0.1, 0, 0));
    expect_vector(flat.origin_dy, V3d(0, -0.1, 0));
}

TEST_F(Cameras, OfAGltfStandWhereItsNodesPutThem)
{
    const std::string text = R"({"asset":{"version":"2.0"},"scene":0,"scenes":[{"nodes":[0,1]}],
        "nodes":[{"mesh":0},{"name":"rig","translation":[1,2,3],"scale":[2,2,2],"children":[2,3]},
                 {"name":"front","camera":0,"rotation":[0,0.7071067811865476,0,0.7071067811865476]},
                 {"name":"wide","camera":1}],
        "cameras":[{"type":"perspective","perspective":{"yfov":1.5707963267948966,"znear":0.1,"aspectRatio":2}},
                   {"type":"orthographic","name":"plan","orthographic":{"xmag":3,"ymag":1.5,"znear":0,"zfar":9}}],)";
    std::string whole = gltf("");
    // The arrays of the fixture's mesh, under our nodes.
    const size_t meshes = whole.find("\"meshes\"");
    ASSERT_NE(meshes, std::string::npos);
    const Mesh mesh = read("cameras.gltf", text + whole.substr(meshes));
    ASSERT_EQ(mesh.cameras.size(), 2u) << testing::PrintToString(mesh.warnings);
    const MeshCamera &front = mesh.cameras[0], &plan = mesh.cameras[1];
    EXPECT_EQ(front.name, "front"); // of its node: it has none
    expect_vector(front.position, V3d(1, 2, 3), 1e-6);
    expect_vector(front.forward, V3d(-1, 0, 0), 1e-6); // -z turned by 90 degrees about y
    expect_vector(front.up, V3d(0, 1, 0), 1e-6);
    EXPECT_NEAR(front.half_height, 1, 1e-6);
    EXPECT_EQ(front.aspect, 2);
    EXPECT_EQ(plan.name, "plan");
    EXPECT_TRUE(plan.is_orthographic);
    EXPECT_EQ(plan.half_height, 1.5);
    EXPECT_EQ(plan.aspect, 2);

    CameraParams params;
    params.camera = "front";
    Camera camera;
    std::string error;
    ASSERT_TRUE(find_camera(camera, params, mesh, 2, error)) << error;
    EXPECT_NEAR(camera.half_width, 2, 1e-6);
    ASSERT_TRUE(find_camera(camera, params, mesh, 1, error)) << error; // a square picture still shows all of its width
    EXPECT_NEAR(camera.half_width, 2, 1e-6);
    EXPECT_NEAR(camera.half_height, 2, 1e-6);
    params.camera = "wide";
    EXPECT_TRUE(find_camera(camera, params, mesh, 1, error)) << error; // by its node
    EXPECT_TRUE(camera.is_orthographic);
    params.camera = "back";
    EXPECT_FALSE(find_camera(camera, params, mesh, 1, error));
    EXPECT_THAT(error, testing::HasSubstr("has no camera \"back\"; it has \"front\", \"plan\""));
}

TEST_F(Cameras, ThatMakeNoPictureAreLeftOutAndNamed)
{
    for (const char* yfov : { "0", "3.2", "-1" }) {
        std::string whole = gltf("");
        const Mesh mesh = read("bad.gltf",
                               R"({"asset":{"version":"2.0"},"scene":0,"scenes":[{"nodes":[0,1]}],
                                   "nodes":[{"mesh":0},{"name":"odd","camera":0}],
                                   "cameras":[{"type":"perspective","perspective":{"znear":0.1,"yfov":)"
                                   + std::string(yfov) + "}}]," + whole.substr(whole.find("\"meshes\"")));
        EXPECT_TRUE(mesh.cameras.empty()) << yfov;
        EXPECT_THAT(mesh.warnings, testing::Contains(testing::HasSubstr("\"odd\""))) << yfov;
    }
}
