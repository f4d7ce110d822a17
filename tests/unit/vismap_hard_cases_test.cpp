// SPDX-License-Identifier: Apache-2.0
// Meshes on which bakers leak, hit themselves, or divide by zero: right answers are exact here.
#include "baked_map.h"
#include "scenes.h"

#include <random>

using namespace vmlight;
using namespace vmlight::scenes;

namespace {

bool sees_all(const Texel& t)
{
    return t.visibility == 1;
}

bool sees_nothing(const Texel& t)
{
    return t.is_zero();
}

bool is_finite(const Texel& t)
{
    return std::isfinite(t.visibility) && std::isfinite(t.direction.x) && std::isfinite(t.direction.y)
        && std::isfinite(t.direction.z);
}

int64_t texels_that_see(const Mesh& mesh, int size, int samples)
{
    const BakedMap map(mesh, {}, map_params(size, size, samples, "sobol"));
    EXPECT_GT(map.report.covered, size * size / 8);
    return count_covered_unless(map, sees_nothing);
}

int64_t texels_that_see_less_than_all(const Mesh& mesh, int size, int samples)
{
    const BakedMap map(mesh, {}, map_params(size, size, samples, "sobol"));
    EXPECT_GT(map.report.covered, size * size / 8);
    return count_covered_unless(map, sees_all);
}

// Each wall's corners lie on the centres of texels, so that texels lie on the very edges and corners of the box; the
// top-left rule gives a wall two of its four edges, the mirrored one the others.
Mesh box_with_texels_on_its_edges(int texels, bool mirrored)
{
    Mesh mesh = box(V3d(-1), V3d(1), true, 0);
    const int across = 3 * (texels + 1), down = 2 * (texels + 1);
    for (int wall = 0; wall < 6; ++wall) {
        const double u0 = (wall % 3) * (texels + 1) + 0.5, v0 = (wall / 3) * (texels + 1) + 0.5;
        double u[2] = { u0 / across, (u0 + texels) / across }, v[2] = { v0 / down, (v0 + texels) / down };
        if (mirrored)
            std::swap(u[0], u[1]), std::swap(v[0], v[1]);
        const int order[4][2] = { { 0, 0 }, { 1, 0 }, { 1, 1 }, { 0, 1 } };
        for (int k = 0; k < 4; ++k)
            mesh.uvs[wall * 4 + k] = V2f(float(u[order[k][0]]), float(v[order[k][1]]));
    }
    return mesh;
}

// A texture over a triangle alone.
Mesh lone_triangle(V3d a, V3d b, V3d c, std::array<V3f, 3> normals)
{
    Mesh mesh;
    mesh.name = "triangle";
    mesh.positions = { a, b, c };
    mesh.normals.assign(normals.begin(), normals.end());
    mesh.uvs = { V2f(0, 0), V2f(1, 0), V2f(0, 1) };
    mesh.triangles = { { 0, 1, 2 } };
    mesh.materials = { 0 };
    return mesh;
}

Mesh upright_triangle(V3f n0, V3f n1, V3f n2)
{
    return lone_triangle(V3d(0, 0, 0), V3d(1, 0, 0), V3d(0, 1, 0), { n0, n1, n2 });
}

const V3d kAskew(0.61, -0.33, 0.72);

} // namespace

TEST(VismapHardCases, InsideAClosedBoxNothingIsSeen)
{
    EXPECT_EQ(texels_that_see(box(V3d(-1), V3d(1), true), 96, 128), 0);
    EXPECT_EQ(texels_that_see(box(V3d(-1), V3d(1), true, 0), 97, 128), 0);
    EXPECT_EQ(texels_that_see(box(V3d(-3, -0.01, -1), V3d(0.2, 0.02, 1.3), true, 0), 97, 128), 0);
}

TEST(VismapHardCases, InsideAClosedBoxNothingIsSeenFromItsVeryEdges)
{
    for (bool mirrored : { false, true }) {
        const int texels = 20;
        const Mesh mesh = box_with_texels_on_its_edges(texels, mirrored);
        const BakedMap map(mesh, {}, map_params(3 * (texels + 1), 2 * (texels + 1), 512, "sobol"));
        EXPECT_EQ(map.report.covered, 6 * texels * texels);
        EXPECT_EQ(count_covered_unless(map, sees_nothing), 0);
    }
}

TEST(VismapHardCases, InsideAClosedBoxAMillionRaysOfATexelFindNoLeak)
{
    for (bool mirrored : { false, true }) {
        const BakedMap map(box_with_texels_on_its_edges(1, mirrored), {}, map_params(6, 4, 1 << 20));
        EXPECT_EQ(map.report.covered, 6); // the corners of the box alone
        EXPECT_EQ(map.report.rays, 6 << 20);
        EXPECT_EQ(count_covered_unless(map, sees_nothing), 0);
    }
}

TEST(VismapHardCases, InsideAClosedBallNothingIsSeen)
{
    EXPECT_EQ(texels_that_see(sphere(V3d(0), 1, 16, true), 96, 128), 0);
    EXPECT_EQ(texels_that_see(sphere(kAskew, 3, 61, true), 95, 128), 0); // vertices and edges on texel centres
}

TEST(VismapHardCases, OutsideAConvexBodyAllIsSeen)
{
    EXPECT_EQ(texels_that_see_less_than_all(box(V3d(-1), V3d(1), false, 0), 97, 64), 0);
    EXPECT_EQ(texels_that_see_less_than_all(sphere(V3d(0), 1, 8), 96, 64), 0);
    EXPECT_EQ(texels_that_see_less_than_all(sphere(kAskew, 0.3, 47), 97, 64), 0);
}

TEST(VismapHardCases, OutsideACoarseBallWithSmoothNormalsAllIsSeen)
{
    // The hemisphere of a smooth normal dips under the facets: rays that start so are no rays.
    for (int cuts : { 0, 1, 2 })
        for (int samples : { 1, 4, 64 }) {
            EXPECT_EQ(texels_that_see_less_than_all(icosphere(cuts), 96, samples), 0) << cuts << ", " << samples;
        }
}

TEST(VismapHardCases, OnACoarseBallTheDirectionLeansLessThanTheFacetsDo)
{
    // Measured: 6.9, 2.4 and 0.7 degrees at most for 20, 80 and 320 triangles, where the normals lean by 37, 20, 10.
    const double most[] = { 7.5, 2.8, 1.0 };
    for (int cuts : { 0, 1, 2 }) {
        const Mesh ball = icosphere(cuts);
        const UvRaster raster(ball, 60, 60);
        TileCover cover;
        raster.cover(0, cover);
        double worst = 0;
        BakedMap(ball, {}, map_params(60, 60, 4096)).each_covered([&](const Texel& t, int x, int y) {
            const int i = y * kTileSize + x;
            const auto& triangle = ball.triangles[cover.triangle[i]];
            const double w1 = cover.weight1[i], w2 = cover.weight2[i];
            const V3d n = V3d(ball.normals[triangle[0]]) * (1 - w1 - w2) + V3d(ball.normals[triangle[1]]) * w1
                + V3d(ball.normals[triangle[2]]) * w2;
            worst = std::max(worst, std::acos(n.normalized().dot(V3d(t.direction).normalized())) * 180 / M_PI);
        });
        EXPECT_LT(worst, most[cuts]) << cuts;
        EXPECT_GT(worst, most[cuts] / 4) << cuts;
    }
}

TEST(VismapHardCases, ScaleAndPlaceOfABallMakeNoFalseHitAndNoLeak)
{
    // Positions are double: what survives of a unit ball at 1e7 in double (2e-9) is more than float keeps of it at 0.
    const std::pair<double, double> table[] = { { 1, 0 },   { 1e-6, 0 },   { 1e6, 0 },   { 1, 1e3 }, { 1, 1e5 },
                                                { 1, 1e7 }, { 1e-3, 1e3 }, { 1e-30, 0 }, { 1e30, 0 } };
    for (const auto& [scale, offset] : table) {
        SCOPED_TRACE(testing::Message() << "scale " << scale << ", offset " << offset);
        EXPECT_EQ(texels_that_see_less_than_all(placed(sphere(V3d(0), 1, 16), scale, V3d(offset)), 64, 64), 0);
        EXPECT_EQ(texels_that_see(placed(sphere(V3d(0), 1, 16, true), scale, V3d(offset)), 64, 64), 0);
    }
}

TEST(VismapHardCases, UnitsOfTheMeshDoNotMatter)
{
    // A bowl under a lid: every texel is partly blocked. Powers of two round nothing, so that maps are bit-equal.
    Mesh scene = sphere(V3d(0), 1, 16, true);
    scene.triangles.resize(scene.triangles.size() / 2);
    append(scene, floor_facing_z(0.4, V3d(0.1, 0.2, -0.3)));
    const VismapParams params = map_params(48, 48, 64);
    const BakedMap reference(scene, {}, params);
    for (double scale : { 0x1p-20, 0x1p20, 0x1p-100 })
        EXPECT_TRUE(BakedMap(placed(scene, scale), {}, params) == reference) << scale;
    // Other scales and places round the vertices otherwise, by 6e-8 of the mesh: the same but for rays within that of
    // an edge, one in thousands.
    for (const auto& [scale, offset] :
         { std::pair(1e-6, 0.0), { 1e6, 0.0 }, { 1.0, 2e4 }, { 1e-3, 20.0 }, { 0.3, 0.0 } }) {
        const BakedMap map(placed(scene, scale, V3d(offset, -offset, offset)), {}, params);
        double worst = 0, changed = 0;
        map.each_covered([&](const Texel& t, int x, int y) {
            const Texel& r = reference.at(x, y);
            const double change = std::abs(t.visibility - r.visibility);
            worst = std::max(worst, change);
            changed += change > 0;
            EXPECT_LT((t.direction - r.direction).length(), 2.5 / 64);
        });
        EXPECT_LE(worst, 2.0 / 64) << scale << ", " << offset; // two rays of 64
        EXPECT_LT(changed, 0.002 * map.report.covered) << scale << ", " << offset;
    }
}

TEST(VismapHardCases, ACoincidentSheetHidesNothing)
{
    for (bool opposed : { false, true })
        for (double scale : { 1.0, 1e-6, 777.7 }) {
            Mesh sheets = floor_facing_z(1);
            const V3d a(-1, -1, 0), b(1, -1, 0), c(1, 1, 0), d(-1, 1, 0);
            if (opposed)
                add_quad(sheets, d, c, b, a);
            else
                add_quad(sheets, a, b, c, d);
            // Cut along the other diagonal and turned out of all planes that floats favour.
            const V3d z = kAskew.normalized(), x = z.cross(V3d(0, 0, 1)).normalized(), y = z.cross(x);
            for (V3d& p : sheets.positions)
                p = (x * p.x + y * p.y) * scale + V3d(0.7, 0.1, -0.2) * scale;
            sheets.normals.assign(sheets.positions.size(), V3f(z));
            EXPECT_EQ(texels_that_see_less_than_all(sheets, 64, 64), 0) << opposed << ", " << scale;
        }
}

TEST(VismapHardCases, BothSidesOfATwoSidedSheetSeeTheirOwnHalf)
{
    Mesh sheets;
    add_quad(sheets, V3d(-1, -1, 0), V3d(1, -1, 0), V3d(1, 1, 0), V3d(-1, 1, 0), V2f(0, 0), V2f(0.5f, 1));
    add_quad(sheets, V3d(-1, 1, 0), V3d(1, 1, 0), V3d(1, -1, 0), V3d(-1, -1, 0), V2f(0.5f, 0), V2f(1, 1));
    BakedMap(sheets, {}, map_params(32, 16, 64)).each([&](const Texel& t, int x, int) {
        EXPECT_EQ(t.visibility, 1);
        EXPECT_NEAR(t.direction.z, x < 16 ? 2.0 / 3 : -2.0 / 3, 1e-6);
    });
}

TEST(VismapHardCases, NormalsSayWhichSideIsOutsideAndNotTheWinding)
{
    Mesh scene = sphere(V3d(0), 1, 12);
    append(scene, box(V3d(0.9, -1, -1), V3d(1.4, 1, 1), true));
    const VismapParams params = map_params(64, 64, 64);
    const BakedMap map(scene, {}, params);
    EXPECT_TRUE(BakedMap(rewound(scene), {}, params) == map);
    EXPECT_EQ(texels_that_see(rewound(box(V3d(-1), V3d(1), true)), 48, 64), 0);
    EXPECT_EQ(texels_that_see_less_than_all(rewound(box(V3d(-1), V3d(1), false)), 48, 64), 0);
}

TEST(VismapHardCases, WithoutAUsableNormalTheTrianglesOwnServes)
{
    const V3f up(0, 0, 1), down(0, 0, -1), zero(0), nan(NAN, NAN, NAN);
    const std::array<V3f, 3> table[] = { { zero, zero, zero }, { nan, nan, nan }, { up, zero, zero }, { up, nan, up },
                                         { up, down, up },     { up, up, down },  { down, up, up } };
    for (const auto& [n0, n1, n2] : table) {
        SCOPED_TRACE(testing::Message() << n0 << n1 << n2);
        const BakedMap map(upright_triangle(n0, n1, n2), {}, map_params(32, 32, 64));
        EXPECT_GT(map.report.covered, 400);
        map.each_covered([&](const Texel& t, int, int) {
            EXPECT_EQ(t.visibility, 1);
            EXPECT_LT((t.direction - V3f(0, 0, 2.0f / 3)).length(), 1e-6f);
        });
    }
    // A corner without a normal does not vote on the side.
    BakedMap(upright_triangle(down, nan, down), {}, map_params(32, 32, 64)).each_covered([&](const Texel& t, int, int) {
        EXPECT_EQ(t.visibility, 1);
        EXPECT_NEAR(t.direction.z, -2.0 / 3, 1e-6);
    });
}

TEST(VismapHardCases, NormalsOfAnyLengthWork)
{
    const VismapParams params = map_params(16, 16, 64);
    const V3f up(0, 0, 1), lean = V3f(0.5f, 0, 0.8f).normalized();
    const BakedMap map(upright_triangle(up, lean, up), {}, params);
    BakedMap(upright_triangle(up * 0.25f, lean * 0.25f, up * 0.25f), {}, params)
        .each_covered(
            [&](const Texel& t, int x, int y) { EXPECT_LT((t.direction - map.at(x, y).direction).length(), 1e-6f); });
}

TEST(VismapHardCases, AnInterpolatedNormalIsOfUnitLength)
{
    // Half way between normals 90 degrees apart the sum has length 0.7.
    const BakedMap map(upright_triangle(V3f(1, 0, 1).normalized(), V3f(-1, 0, 1).normalized(), V3f(0, 0, 1)), {},
                       map_params(33, 33, 4096));
    map.each_covered([&](const Texel& t, int, int) {
        EXPECT_EQ(t.visibility, 1);
        EXPECT_GE(t.direction.length(), 2.0f / 3 - 1e-3f);
        EXPECT_LE(t.direction.length(), 1.0f);
    });
}

TEST(VismapHardCases, SliversSeeAsWideTrianglesDo)
{
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
}

TEST(VismapHardCases, TrianglesWithoutAreaInSpaceAreCountedAndNeitherBakedNorCast)
{
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
    scene.materials.resize(4);
    const BakedMap map(scene, {}, map_params(32, 32, 64));
    EXPECT_EQ(map.report.uv.degenerate_3d, 2);
    EXPECT_EQ(map.report.covered, 512);
    map.each([](const Texel& t, int, int y) {
        if (y >= 16)
            EXPECT_EQ(t.visibility, 1);
        else
            EXPECT_TRUE(t.is_zero());
    });
}

TEST(VismapHardCases, NoiseForAMeshGivesFiniteMapsWithinTheirRange)
{
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
        soup.materials.resize(100);
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
}
