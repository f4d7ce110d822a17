// SPDX-License-Identifier: Apache-2.0
// Terrain from images of heights: where pixels go, and closed forms of what a slope and a valley see.
#include "baked_map.h"
#include "mesh_fixture.h"

#include <vmlight/mesh/import/height_field.h>
#include <vmlight/stage/recipe/unused_flags.h>

#include <OpenImageIO/imagebuf.h>

#include <gmock/gmock.h>

#include <cmath>
#include <functional>
#include <limits>

using namespace mesh_files;
using testing::HasSubstr;

namespace {

using Height = std::function<float(int column, int row)>;

class HeightField : public MeshFiles
{
protected:
    std::string write_image(const char* name, int width, int height, const Height& height_at, const char* channel = "Y",
                            OIIO::TypeDesc format = OIIO::TypeFloat)
    {
        OIIO::ImageSpec spec(width, height, 1, format);
        spec.channelnames = { channel };
        OIIO::ImageBuf image(spec);
        for (int y = 0; y < height; ++y)
            for (int x = 0; x < width; ++x) {
                const float value = height_at(x, y);
                image.setpixel(x, y, &value, 1);
            }
        EXPECT_TRUE(image.write(folder / name)) << image.geterror();
        return folder / name;
    }
    std::string said(const std::string& path, const MeshParams& params)
    {
        Mesh mesh;
        std::string error;
        EXPECT_FALSE(read_mesh(mesh, path, params, error));
        return error;
    }
    static MeshParams spaced(const char* spacing, double scale = 1)
    {
        MeshParams params;
        params.terrain = spacing;
        params.height_scale = scale;
        return params;
    }
};

} // namespace

TEST_F(HeightField, ThePictureIsTheViewFromAbove)
{
    const std::string path = write_image("a.exr", 3, 2, [](int x, int y) { return float(10 * y + x); });
    const Mesh mesh = read(path, spaced("2m/px", 0.5));
    ASSERT_EQ(mesh.positions.size(), 6u);
    ASSERT_EQ(mesh.triangles.size(), 4u);
    for (int y = 0; y < 2; ++y)
        for (int x = 0; x < 3; ++x) {
            const size_t v = size_t(3 * y + x);
            EXPECT_EQ(mesh.positions[v], V3d(2 * (x - 1), 0.5 * (10 * y + x), 2 * (y - 0.5)));
            EXPECT_FLOAT_EQ(mesh.uvs[v].x, float(x + 0.5) / 3);
            EXPECT_FLOAT_EQ(mesh.uvs[v].y, 1 - float(y + 0.5) / 2) << "v is up: the top row has the largest";
        }
    for (const auto& triangle : mesh.triangles)
        EXPECT_GT(triangle_area_normal(mesh, triangle).y, 0) << "the sky is outside";
}

TEST_F(HeightField, APlaneSeesAllOfTheSkyAboveItAndLeansAsItsGradientSays)
{
    const double east = 0.5, south = -0.25; // rises to the right, falls to the bottom
    const std::string path
        = write_image("a.tif", 17, 17, [&](int x, int y) { return float(3 * (east * x + south * y)); });
    const Mesh mesh = read(path, spaced("3"));
    const V3f normal(V3d(-east, 1, -south).normalized());
    for (const V3f& n : mesh.normals)
        EXPECT_LT((n - normal).length(), 1e-6);
    for (const auto& triangle : mesh.triangles)
        EXPECT_LT((V3f(triangle_area_normal(mesh, triangle).normalized()) - normal).length(), 1e-6);
    VismapParams params;
    params.width = params.height = 17;
    params.samples = 256;
    params.margin = 0;
    const BakedMap map(mesh, {}, params);
    for (const int at : { 2, 8, 14 }) {
        EXPECT_NEAR(map.at(at, 8).visibility, 1, 1e-6);
        EXPECT_LT((map.at(at, 8).direction - normal * (2 / 3.f)).length(), 0.01);
    }
}

TEST_F(HeightField, AValleySeesTheWedgeBetweenItsSides)
{
    // A V along z: walls of slope `rise` that end 10 pixels from the bottom, and far away in z.
    const double rise = 0.75;
    const std::string path = write_image("a.exr", 21, 801, [&](int x, int) { return float(rise * std::abs(x - 10)); });
    const Mesh mesh = read(path, spaced("1m/px"));
    VismapParams params;
    params.width = 42; // texels are a quarter of a pixel off the vertices
    params.height = 9; // of which the middle one is as far from both ends as it gets
    params.samples = 1024;
    params.margin = 0;
    const BakedMap map(mesh, {}, params);
    for (const int texel : { 8, 9, 14, 15, 26, 27, 32 }) {
        const double x = (texel + 0.5) / 2 - 0.5 - 10, side = x < 0 ? -1 : 1;
        // In the cross section: from down its own wall to the top of the other one.
        const double up = rise * (10 - std::abs(x)), across = 10 + std::abs(x);
        const double blocked = std::atan(rise) + std::atan2(up, across);
        const double truth = (1 + std::cos(blocked)) / 2;
        const Texel found = map.at(texel, 4);
        EXPECT_NEAR(found.visibility, truth, 0.01) << x;
        EXPECT_LT(found.direction.x * side, 0) << "the open sky is over the middle of the valley: " << x;
        EXPECT_NEAR(found.direction.z, 0, 0.01);
        EXPECT_GT(found.direction.y, 0);
    }
}

TEST_F(HeightField, AQuadIsCutAlongTheDiagonalThatIsFlatter)
{
    const auto shared = [&](float a, float b, float c, float d) { // a d above b c
        const float heights[] = { a, d, b, c };
        const Mesh mesh
            = read(write_image("q.exr", 2, 2, [&](int x, int y) { return heights[2 * y + x]; }), spaced("1"));
        std::vector<int> uses(4, 0);
        for (const auto& triangle : mesh.triangles)
            for (const uint32_t v : triangle)
                ++uses[v];
        return uses;
    };
    EXPECT_EQ(shared(0, 1, 0, 0), (std::vector<int> { 2, 1, 1, 2 }));
    EXPECT_EQ(shared(1, 0, 0, 0), (std::vector<int> { 1, 2, 2, 1 }));
}

TEST_F(HeightField, PixelsThatAreNotANumberAreHoles)
{
    const float nan = std::numeric_limits<float>::quiet_NaN();
    const auto holes = [&](int column, int row) {
        return read(write_image("h.exr", 4, 4, [&](int x, int y) { return x == column && y == row ? nan : 1; }),
                    spaced("1"));
    };
    const Mesh corner = holes(0, 0), middle = holes(1, 2);
    EXPECT_EQ(corner.positions.size(), 15u);
    EXPECT_EQ(corner.triangles.size(), 17u) << "the triangle of the other three is there";
    EXPECT_EQ(middle.triangles.size(), 18u - 4);
    EXPECT_THAT(middle.warnings, testing::Contains(HasSubstr("1 of 16 pixels has no height")));
    std::string error;
    EXPECT_TRUE(check_mesh(middle, error)) << error;
    EXPECT_THAT(said(write_image("n.exr", 3, 3, [&](int, int) { return nan; }), spaced("1")),
                HasSubstr("no triangles"));
    const std::string low = write_image("l.exr", 3, 3, [](int x, int y) { return x == 2 && y == 1 ? -3.4e38f : 1; });
    EXPECT_THAT(said(low, spaced("1")), HasSubstr("pixel (2, 1) has the height -3.4"));
    const float inf = std::numeric_limits<float>::infinity();
    EXPECT_THAT(said(write_image("i.exr", 3, 3, [&](int, int) { return inf; }), spaced("1")),
                HasSubstr("pixel (0, 0) has the height inf"));
}

TEST_F(HeightField, IntegersAreZeroToOne)
{
    const std::string path = write_image(
        "a.png", 2, 2, [](int x, int) { return float(x); }, "Y", OIIO::TypeUInt16);
    const Mesh mesh = read(path, spaced("1", 300));
    EXPECT_EQ(mesh.positions[0].y, 0);
    EXPECT_EQ(mesh.positions[1].y, 300);
}

TEST_F(HeightField, ADataWindowKeepsItsPlaceInThePicture)
{
    OIIO::ImageSpec spec(2, 2, 1, OIIO::TypeFloat);
    spec.x = 4, spec.y = 1, spec.full_width = 8, spec.full_height = 4;
    OIIO::ImageBuf image(spec);
    ASSERT_TRUE(image.write(folder / "w.exr"));
    const Mesh mesh = read(folder / "w.exr", spaced("1"));
    EXPECT_EQ(mesh.positions[0], V3d(0.5, 0, -0.5));
    EXPECT_FLOAT_EQ(mesh.uvs[0].x, 4.5f / 8);
    EXPECT_FLOAT_EQ(mesh.uvs[0].y, 1 - 1.5f / 4);
}

TEST_F(HeightField, WhatIsNoTerrainIsRefused)
{
    const std::string flat = write_image("a.exr", 2, 2, [](int, int) { return 0.f; });
    EXPECT_THAT(said(flat, {}), HasSubstr("give the distance between its pixels, as in --terrain 1.5m/px"));
    for (const char* bad : { "0", "-1", "x", "1.5km/px", "1.5m", "nan", "inf", "1 2" })
        EXPECT_THAT(said(flat, spaced(bad)), HasSubstr(std::string("terrain: \"") + bad + "\" is not the distance"))
            << bad;
    EXPECT_THAT(said(write_image("thin.exr", 1, 5, [](int, int) { return 0.f; }), spaced("1")),
                HasSubstr("at least 2x2"));
    OIIO::ImageBuf color(OIIO::ImageSpec(2, 2, 3, OIIO::TypeFloat));
    ASSERT_TRUE(color.write(folder / "c.exr"));
    EXPECT_THAT(said(folder / "c.exr", spaced("1")), HasSubstr("3 channels (R, G, B); a height image has one"));
    EXPECT_THAT(said(folder.write("t.exr", std::string("\x76\x2f\x31\x01", 4) + "cut"), spaced("1")),
                HasSubstr("not an image that can be read"));
    double spacing = 0;
    std::string error;
    EXPECT_TRUE(parse_pixel_spacing(spacing, " 0.1 m/px", error));
    EXPECT_EQ(spacing, 0.1) << "in double";
    VismapRecipe recipe;
    recipe.mesh = folder.write("m.obj", kQuadObj);
    recipe.mesh_params.terrain = "1";
    EXPECT_EQ(unused_reason(recipe, "terrain"), "neither the mesh nor an occluder is an image of heights");
    recipe.occluder = { flat };
    EXPECT_EQ(unused_reason(recipe, "terrain"), "");
}
