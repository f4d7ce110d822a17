// SPDX-License-Identifier: Apache-2.0
// Normals that are zero, not numbers, opposed, of any length, or lean under the surface.
#include "hard_case.h"
#include "judgement.h"
#include "scenes.h"

#include <vmlight/math/sampling.h>
#include <vmlight/uv/raster.h>
#include <vmlight/vismap/visibility_integrator.h>

using namespace vmlight;
using namespace vmlight::scenes;

namespace {

// A texture over a triangle alone.
Mesh lone_triangle(V3d a, V3d b, V3d c, std::array<V3f, 3> normals)
{
    Mesh mesh;
    mesh.name = "triangle";
    mesh.positions = { a, b, c };
    mesh.normals.assign(normals.begin(), normals.end());
    mesh.uvs = { V2f(0, 0), V2f(1, 0), V2f(0, 1) };
    mesh.triangles = { { 0, 1, 2 } };
    mesh.triangle_materials = { 0 };
    return mesh;
}

Mesh upright_triangle(V3f n0, V3f n1, V3f n2)
{
    return lone_triangle(V3d(0, 0, 0), V3d(1, 0, 0), V3d(0, 1, 0), { n0, n1, n2 });
}

} // namespace

TEST(Geometry, ACoarseBallWithSmoothNormals)
{
    HardCase row("Spheres of 20, 80 and 320 triangles with smooth normals",
                 "Bakery, glim, Cycles: stepped shadow terminator");
    // The mean share of the hemisphere of the smooth normal that lies above the facet: V, where rays below it are
    // blocked.
    const Mesh coarse = icosphere(0);
    double share = 0;
    for (const auto& triangle : coarse.triangles) {
        const V3d facet = triangle_area_normal(coarse, triangle).normalized();
        share += (1 + facet.dot(V3d(coarse.normals[triangle[0]]))) / 2 / double(coarse.triangles.size());
    }
    EXPECT_LT(share, 0.91);
    row.naive("the hemisphere dips below the facets: V is below 0.91 at the corners of 20 triangles");
    // The hemisphere of a smooth normal dips under the facets: rays that start so are no rays.
    for (int cuts : { 0, 1, 2 })
        for (int samples : { 1, 4, 64 }) {
            EXPECT_EQ(texels_that_see_less_than_all(icosphere(cuts), 96, samples), 0) << cuts << ", " << samples;
        }
    row.ours("V = 1 exactly");
}

TEST(Geometry, TheDirectionOfACoarseBall)
{
    HardCase row("The mean direction on the same spheres");
    row.naive("the facet normal: wrong by up to 37 degrees");
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
    row.ours("wrong by less than 7.5, 2.8 and 1 degrees");
}

TEST(Geometry, WindingIsNotWhatSaysOutside)
{
    HardCase row("A sphere and a box with reversed winding");
    row.naive("sees the inside: V = 0");
    Mesh scene = sphere(V3d(0), 1, 12);
    append(scene, box(V3d(0.9, -1, -1), V3d(1.4, 1, 1), true));
    const VismapParams params = map_params(64, 64, 64);
    const BakedMap map(scene, {}, params);
    EXPECT_TRUE(BakedMap(rewound(scene), {}, params) == map);
    EXPECT_EQ(texels_that_see(rewound(box(V3d(-1), V3d(1), true)), 48, 64), 0);
    EXPECT_EQ(texels_that_see_less_than_all(rewound(box(V3d(-1), V3d(1), false)), 48, 64), 0);
    row.ours("the normals decide which side is outside: the same map");
}

TEST(Geometry, NoUsableNormal)
{
    HardCase row("Normals that are zero, NaN or opposed, or only partly there",
                 "Filament's rays: interpolated, not renormalised");
    EXPECT_TRUE(std::isnan((V3f(0) / V3f(0).length()).x));
    row.naive("0 / 0: NaN");
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
    row.ours("the triangle's normal n is used: V = 1, B = (2/3) n");
}

TEST(Geometry, NormalsOfAnyLength)
{
    HardCase row("Normals of length 1/4");
    row.naive("B is a quarter as long");
    const VismapParams params = map_params(16, 16, 64);
    const V3f up(0, 0, 1), lean = V3f(0.5f, 0, 0.8f).normalized();
    const BakedMap map(upright_triangle(up, lean, up), {}, params);
    BakedMap(upright_triangle(up * 0.25f, lean * 0.25f, up * 0.25f), {}, params)
        .each_covered(
            [&](const Texel& t, int x, int y) { EXPECT_LT((t.direction - map.at(x, y).direction).length(), 1e-6f); });
    row.ours("the same map");
}

TEST(Geometry, InterpolatedNormals)
{
    HardCase row("Corner normals 90 degrees apart, whose interpolation is only 0.7 long",
                 "Filament's rays: interpolated, not renormalised");
    row.naive("directions and B are 0.7 as long");
    // Half way between normals 90 degrees apart the sum has length 0.7.
    const BakedMap map(upright_triangle(V3f(1, 0, 1).normalized(), V3f(-1, 0, 1).normalized(), V3f(0, 0, 1)), {},
                       map_params(33, 33, 4096));
    map.each_covered([&](const Texel& t, int, int) {
        EXPECT_EQ(t.visibility, 1);
        EXPECT_GE(t.direction.length(), 2.0f / 3 - 1e-3f);
        EXPECT_LE(t.direction.length(), 2.0f / 3 * (1 + 1e-6f));
    });
    row.ours("|B| = 2/3");
}

TEST(Geometry, ALoneRayAtTheHorizon)
{
    HardCase row("One ray a texel with the measure `uniform`, 2^-24 above the horizon");
    row.naive("rounded below the horizon: 0 of 0 rays, NaN");
    // A texel and a seed whose one ray is the lowest there is.
    VismapParams params = map_params(1, 1, 1);
    params.measure = "uniform";
    int found = 0;
    for (int seed = 0; seed < 1 << 26 && found < 3; ++seed) {
        if (texel_hash(0, 0, uint32_t(seed)).u < 0xffffff00u)
            continue;
        ++found;
        params.seed = seed;
        for (int turn = 0; turn < 40; ++turn) {
            const V3f n = V3f(float(std::sin(turn)), 0.3f, float(std::cos(turn))).normalized();
            const V3d a = V3d(n).cross(V3d(0, 1, 0)).normalized(), b = V3d(n).cross(a);
            Mesh mesh = lone_triangle(V3d(0), a, b, { n, n, n });
            mesh.uvs = { V2f(-1, -1), V2f(3, -1), V2f(-1, 3) };
            const Texel texel = BakedMap(mesh, {}, params).at(0, 0);
            EXPECT_TRUE(is_finite(texel));
            EXPECT_EQ(texel.visibility, 1);
        }
    }
    EXPECT_EQ(found, 3);
    row.ours("a ray along the normal replaces it: V = 1");
}
