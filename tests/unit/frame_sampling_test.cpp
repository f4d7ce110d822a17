// SPDX-License-Identifier: Apache-2.0
// Which samples a pixel takes: edges, seams and corners; and what must not change them.
#include "frame_scenes.h"

#include <vmlight/frame/corner_grid.h>

#include <gtest/gtest.h>

#include <cmath>
#include <cstring>

using namespace vmlight;
using namespace vmlight::frame_scenes;
using Imath::V2f;
using Imath::V3d;
using Imath::V3f;
using OIIO::ImageBuf;

// A square turned by some degrees: what of each pixel it covers, by many more samples.
TEST(RenderFrame, EdgesAreTheShareOfThePixelThatIsCovered)
{
    Mesh mesh = scenes::floor_facing_z(0.6);
    const Rotation turn = rotation_from_angles(0, 0, 17);
    for (V3d& position : mesh.positions)
        position = rotate(turn, position);
    const FrameScene scene = scene_of({ surface_of(mesh, { 2, 2, 2 }) });
    const ImageBuf truth = rendered(scene, square_on(), params_of(24, 4096));
    const ImageBuf image = rendered(scene, square_on(), params_of(24, 64));
    double area = 0;
    for (int y = 0; y < 24; ++y)
        for (int x = 0; x < 24; ++x) {
            EXPECT_NEAR(image.getchannel(x, y, 0, 3), truth.getchannel(x, y, 0, 3), 0.03);
            EXPECT_NEAR(image.getchannel(x, y, 0, 0), 2 * image.getchannel(x, y, 0, 3), 1e-5);
            area += double(truth.getchannel(x, y, 0, 3)) * 4 / (24 * 24);
        }
    EXPECT_NEAR(area, 1.2 * 1.2, 1e-3);
}

TEST(RenderFrame, AnyNumberOfThreadsGivesTheSameBits)
{
    const FrameScene scene = scene_of({ surface_of(scenes::sphere(V3d(0), 1, 12), { 1, 2, 3 }) });
    RenderParams params = params_of(70, 5, "gaussian");
    params.layers = { "normal", "depth", "uv" };
    const ImageBuf one = rendered(scene, square_on(), params, 1), many = rendered(scene, square_on(), params, 7);
    EXPECT_EQ(std::memcmp(one.localpixels(), many.localpixels(), size_t(one.spec().image_bytes())), 0);
}

TEST(RenderFrame, HardMeshesGiveFinitePictures)
{
    Mesh mesh = scenes::floor_facing_z(1);
    // Triangles without area, without UVs, and seen edge on.
    scenes::add_quad(mesh, V3d(0), V3d(0), V3d(0), V3d(0));
    scenes::add_quad(mesh, V3d(0.5, -1, 0.5), V3d(0.5, 1, 0.5), V3d(0.5, 1, 1), V3d(0.5, -1, 1));
    mesh.normals[0] = V3f(0);
    FrameSurface surface = surface_of(mesh);
    RenderParams params = params_of(16, 4);
    params.layers = { "albedo", "lit", "visibility", "direction", "normal", "position", "uv", "depth" };
    for (const double shift : { 0.0, 1e7 }) {
        FrameSurface moved = surface;
        moved.mesh = shared(scenes::placed(mesh, 1, V3d(shift, 0, 0)));
        Camera camera = square_on(false);
        camera.position.x += shift;
        const ImageBuf image = rendered(scene_of({ moved }), camera, params);
        const auto* values = static_cast<const float*>(image.localpixels());
        for (size_t i = 0; i < size_t(image.spec().image_pixels()) * size_t(image.nchannels()); ++i)
            ASSERT_TRUE(std::isfinite(values[i])) << image.spec().channelnames[i % size_t(image.nchannels())]
                                                  << " of pixel " << i / size_t(image.nchannels());
        EXPECT_EQ(pixel(image, 2, 8)[3], 1) << shift;
    }
}

// Light that varies over a ball: what is mixed from corners, and what all samples say.
TEST(RenderFrame, CornersAreEnoughInsideASurface)
{
    const int side = 64;
    std::vector<float> texels;
    for (int y = 0; y < side; ++y)
        for (int x = 0; x < side; ++x)
            for (int c = 0; c < 3; ++c)
                texels.push_back(1 + 0.5f * std::sin(0.2f * float(x + c)) * std::cos(0.3f * float(y)));
    FrameSurface ball;
    ball.mesh = shared(scenes::sphere(V3d(0), 0.9, 32));
    ball.light = texture_of(side, side, texels);
    const FrameScene scene = scene_of({ ball });
    for (const char* filter : { "blackman-harris", "gaussian", "box" }) {
        RenderParams params = params_of(128, 64, filter);
        const ImageBuf edges = rendered(scene, square_on(), params);
        params.sampling = "all";
        const ImageBuf all = rendered(scene, square_on(), params);
        double squares = 0, sum = 0;
        int same = 0, covered = 0;
        for (int y = 0; y < 128; ++y)
            for (int x = 0; x < 128; ++x) {
                const auto a = pixel(edges, x, y), b = pixel(all, x, y);
                EXPECT_EQ(a[3], b[3]); // what is covered in part is sampled
                if (b[3] < 1) {
                    EXPECT_EQ(a, b);
                }
                covered += b[3] == 1;
                same += b[3] == 1 && a == b;
                squares += double(a[0] - b[0]) * double(a[0] - b[0]);
                sum += double(b[0]);
            }
        EXPECT_LT(std::sqrt(squares * 128 * 128) / sum, 4e-3) << filter;
        EXPECT_LT(same, covered / 2) << filter; // most are mixed
    }
}

// Two halves of one mesh whose textures do not go on in each other: the pixels on the seam get all samples.
TEST(RenderFrame, SeamsAreSampled)
{
    Mesh mesh;
    scenes::add_quad(mesh, V3d(-1, -1, 0), V3d(0, -1, 0), V3d(0, 1, 0), V3d(-1, 1, 0), V2f(0, 0), V2f(0.4f, 1));
    scenes::add_quad(mesh, V3d(0, -1, 0), V3d(1, -1, 0), V3d(1, 1, 0), V3d(0, 1, 0), V2f(0.6f, 0), V2f(1, 1));
    std::vector<float> texels;
    for (int x = 0; x < 10; ++x)
        texels.insert(texels.end(), 3, x < 5 ? 1.0f : 3.0f);
    FrameSurface surface;
    surface.mesh = shared(mesh);
    surface.light = texture_of(10, 1, texels);
    const FrameScene scene = scene_of({ surface });
    RenderParams params = params_of(15, 16);
    const ImageBuf edges = rendered(scene, square_on(), params);
    params.sampling = "all";
    const ImageBuf all = rendered(scene, square_on(), params);
    for (int y = 2; y < 13; ++y) {
        EXPECT_EQ(pixel(edges, 7, y), pixel(all, 7, y)); // the seam is in its middle
        EXPECT_NEAR(edges.getchannel(7, y, 0, 0), 2, 1e-5);
        EXPECT_NEAR(edges.getchannel(3, y, 0, 0), 1, 1e-5);
        EXPECT_NEAR(edges.getchannel(11, y, 0, 0), 3, 1e-5);
    }
}

TEST(CornerGrid, WeightsHaveTheVarianceOfTheFilter)
{
    for (const Choice& filter : pixel_filter_choices().choices) {
        const auto weights = CornerGrid::weights(filter_variance(filter.word));
        double sum = 0, variance = 0;
        for (int i = 0; i < CornerGrid::kAround; ++i) {
            sum += weights[size_t(i)];
            variance += weights[size_t(i)] * (i - 1.5) * (i - 1.5);
        }
        EXPECT_NEAR(sum, 1, 1e-12) << filter.word;
        EXPECT_NEAR(variance, filter_variance(filter.word), 1e-12) << filter.word;
    }
}

TEST(RenderFrame, TheSizeOfTheMeshDoesNotMatter)
{
    for (const double scale : { 1e-30, 1e-6, 1.0, 1e6, 1e30 }) {
        const FrameScene scene = scene_of({ surface_of(scenes::placed(scenes::floor_facing_z(1), scale)) });
        Camera camera = square_on(false);
        camera.position *= scale;
        const ImageBuf image = rendered(scene, camera, params_of(8));
        for (int i = 0; i < 64; ++i)
            EXPECT_EQ(pixel(image, i % 8, i / 8), (std::vector<float> { 1, 1, 1, 1 })) << scale;
    }
}

TEST(RenderFrame, StopsWhenAsked)
{
    const FrameScene scene = scene_of({ surface_of(scenes::floor_facing_z(1)) });
    ImageBuf image;
    std::string error;
    EXPECT_FALSE(render_frame(
        image, scene, square_on(), params_of(256), 1, [](double) { return false; }, error));
    EXPECT_EQ(error, "interrupted");
}
