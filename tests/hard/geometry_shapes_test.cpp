// SPDX-License-Identifier: Apache-2.0
// Triangles without area, slivers, one, none, millions, and noise.
#include "hard_case.h"
#include "judgement.h"
#include "scenes.h"
#include "watchdog.h"

#include <random>

using namespace vmlight;
using namespace vmlight::scenes;

TEST(Geometry, SliversBesideAWall)
{
    HardCase row("A square made of a fan of slivers, the thinnest 1e-7 wide, at the foot of a wall",
                 "embree#387: false hits at grazing slivers");
    row.naive("the normal of a sliver is mostly rounding error");
    // A unit square as a fan of slivers, the thinnest 1e-7 wide, beside a wall whose foot they touch.
    Mesh scene;
    scene.name = "slivers";
    std::vector<double> cuts { 0, 1e-7, 3e-7, 1e-6, 1e-5, 1e-4, 1e-3, 1e-2, 0.1, 0.5, 1 };
    for (size_t i = 0; i + 1 < cuts.size(); ++i) {
        const float u0 = float(i) / float(cuts.size() - 1), u1 = float(i + 1) / float(cuts.size() - 1);
        add_quad(scene, V3d(cuts[i], -1, 0), V3d(cuts[i + 1], -1, 0), V3d(cuts[i + 1], 1, 0), V3d(cuts[i], 1, 0),
                 V2f(u0, 0), V2f(u1, 1));
    }
    scene.normals.assign(scene.positions.size(), V3f(0, 0, 1));
    const BakedMap open(scene, {}, map_params(40, 40, 64));
    EXPECT_EQ(open.report.covered, 1600);
    EXPECT_EQ(count_covered_unless(open, sees_all), 0);
    const BakedMap map(scene, { rectangle(V3d(0, -1e5, 0), V3d(0, 2e5, 0), V3d(0, 0, 1e5)) }, map_params(40, 40, 4096));
    map.each([](const Texel& t, int x, int) {
        EXPECT_NEAR(t.visibility, 0.5, 0.005) << x;
        EXPECT_NEAR(t.direction.x, 2 / (3 * M_PI), 0.005) << x;
    });
    row.ours("V and B of the closed form");
}

TEST(Geometry, TrianglesWithoutArea)
{
    HardCase row("A needle and a point among the triangles", "Gaffer PR#2998: a crash");
    EXPECT_TRUE(std::isnan((V3f(0) / V3f(0).length()).x));
    row.naive("their normal is 0 / 0: NaN");
    Mesh scene = floor_facing_z(1);
    for (V2f& uv : scene.uvs)
        uv.y *= 0.5f;
    const uint32_t first = uint32_t(scene.positions.size());
    for (double x : { -1.0, 0.0, 1.0 })
        scene.positions.push_back(V3d(x, 0, 0.5)); // a needle over the floor
    scene.positions.push_back(V3d(0, 0, 0.1));
    scene.normals.resize(scene.positions.size(), V3f(0, 0, 1));
    scene.uvs.insert(scene.uvs.end(), { V2f(0, 0.5f), V2f(1, 0.5f), V2f(1, 1), V2f(0, 1) });
    scene.triangles.push_back({ first, first + 1, first + 2 });
    scene.triangles.push_back({ first + 3, first + 3, first + 3 });
    scene.triangle_materials.resize(4);
    const BakedMap map(scene, {}, map_params(32, 32, 64));
    EXPECT_EQ(map.report.uv.degenerate_3d, 2);
    EXPECT_EQ(map.report.covered, 512);
    map.each([](const Texel& t, int, int y) {
        if (y >= 16)
            EXPECT_EQ(t.visibility, 1);
        else
            EXPECT_TRUE(t.is_zero());
    });
    row.ours("counted; neither baked nor traced");
}

TEST(Geometry, Noise)
{
    HardCase row("Random triangles, normals and texture coordinates, in space and in a plane");
    row.naive("NaN from every division by 0");
    std::mt19937 random(7);
    std::uniform_real_distribution<double> in(-1, 1);
    for (int run = 0; run < 8; ++run) {
        Mesh soup;
        soup.name = "soup";
        for (int v = 0; v < 60; ++v) {
            soup.positions.push_back(V3d(in(random), in(random), run % 2 ? 0 : in(random)));
            soup.normals.push_back(V3f(float(in(random)), float(in(random)), float(in(random))));
            soup.uvs.push_back(V2f(float(in(random)), float(in(random))));
        }
        for (int t = 0; t < 100; ++t)
            soup.triangles.push_back({ uint32_t(random() % 60), uint32_t(random() % 60), uint32_t(random() % 60) });
        soup.triangle_materials.resize(100);
        for (const char* measure : { "cosine", "uniform" }) {
            VismapParams params = map_params(32, 32, 16);
            params.measure = measure;
            const BakedMap map(soup, {}, params);
            EXPECT_GT(map.report.covered, 100);
            map.each([](const Texel& t, int, int) {
                EXPECT_TRUE(is_finite(t));
                EXPECT_GE(t.visibility, 0);
                EXPECT_LE(t.visibility, 1);
                EXPECT_LE(t.direction.length(), t.visibility * (1 + 1e-6f));
            });
        }
    }
    row.ours("finite, 0 <= |B| <= V <= 1");
}

TEST(Geometry, DuplicateFaces)
{
    HardCase row("A sphere with every triangle three times", "VertexOven#9");
    row.naive("it occludes itself");
    Mesh mesh = sphere(V3d(0), 1, 12);
    const Mesh once = mesh;
    append(mesh, once);
    append(mesh, once);
    const BakedMap map(mesh, {}, map_params(64, 64, 64));
    EXPECT_EQ(count_covered_unless(map, sees_all), 0);
    EXPECT_EQ(map.report.overlapping, map.report.covered);
    EXPECT_TRUE(map == BakedMap(once, {}, map_params(64, 64, 64)));
    row.ours("the map of a single sphere; the overlap is counted");
}

TEST(Geometry, NoneAndOne)
{
    HardCase row("A mesh of no triangle, and of one triangle");
    row.naive("empty bounds are infinite; an empty buffer crashes the ray tracer");
    std::string error;
    OIIO::ImageBuf image;
    Mesh none = floor_facing_z(1);
    none.triangles.clear();
    EXPECT_FALSE(make_vismap(image, none));
    EXPECT_EQ(image.geterror(), "\"floor\": no triangles");
    Mesh one = floor_facing_z(1);
    one.triangles.pop_back();
    const BakedMap map(one, {}, map_params(16, 16, 16));
    EXPECT_EQ(map.report.covered, 136);
    EXPECT_EQ(count_covered_unless(map, sees_all), 0);
    row.ours("refused; baked");
}

TEST(Geometry, MeshesThatAreNone)
{
    HardCase row("Meshes in memory with NaN, infinity or vertex indices out of range", "xatlas#54: freezes, NaN");
    row.naive("reads past the end, or traces NaN");
    const auto refusal = [](const auto& spoil) {
        Mesh mesh = floor_facing_z(1);
        spoil(mesh);
        OIIO::ImageBuf image;
        EXPECT_FALSE(make_vismap(image, mesh));
        const std::string as_baked = image.geterror();
        EXPECT_FALSE(make_vismap(image, sphere(V3d(0), 1, 4), { mesh }));
        EXPECT_EQ(image.geterror(), as_baked);
        return as_baked;
    };
    EXPECT_EQ(refusal([](Mesh& m) { m.triangles[1][2] = 4; }),
              "\"floor\": triangle 1 uses vertex 4, but there are only 4");
    EXPECT_EQ(refusal([](Mesh& m) { m.positions[2].y = INFINITY; }), "\"floor\": vertex 2 is not finite: (1, inf, 0)");
    EXPECT_EQ(refusal([](Mesh& m) { m.positions[0].x = NAN; }), "\"floor\": vertex 0 is not finite: (nan, -1, 0)");
    EXPECT_EQ(refusal([](Mesh& m) { m.normals.pop_back(); }), "\"floor\": 3 normals for 4 vertices");
    EXPECT_EQ(refusal([](Mesh& m) { m.uvs.pop_back(); }), "\"floor\": 3 texture coordinates for 4 vertices");
    row.ours("refused, naming the first; occluders too");
}

TEST(Geometry, TenMillionTriangles)
{
    extend_watchdog(5);
    HardCase row("A sphere of ten million triangles (a million under sanitizers)");
    row.naive("an index stored in a float is off by one from the 16777217th corner on");
    EXPECT_EQ(float((1 << 24) + 1), float(1 << 24));
    const Mesh mesh = sphere(V3d(0), 1, VMLIGHT_HARD_RINGS);
    const BakedMap map(mesh, {}, map_params(256, 256, 4));
    EXPECT_EQ(count_covered_unless(map, sees_all), 0);
    EXPECT_GT(map.report.covered, 256 * 256 - 256 * 2);
    EXPECT_EQ(map.report.uv.islands, 1);
    row.ours("V = 1");
}
