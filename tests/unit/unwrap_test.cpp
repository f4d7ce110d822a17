// SPDX-License-Identifier: Apache-2.0
// Atlases of meshes without UVs.
#include "atlas.h"
#include "baked_map.h"

#include <vmlight/mesh/import/read_mesh.h>
#include <vmlight/stage/unwrap_report.h>

#include <gmock/gmock.h>

using namespace vmlight;
using namespace vmlight::scenes;

namespace {

Mesh read_data(const std::string& name)
{
    Mesh mesh;
    std::string error;
    EXPECT_TRUE(read_mesh(mesh, std::string(VMLIGHT_TEST_DATA) + "/" + name, {}, error)) << error;
    return mesh;
}

VismapParams bake_params(const UnwrapParams& atlas)
{
    VismapParams params;
    params.resolution = { atlas.width, atlas.height };
    params.margin = atlas.margin;
    params.samples = 32;
    params.channels = { "coverage" };
    return params;
}

std::string atlas_refusal(Mesh mesh, const UnwrapParams& params)
{
    const std::vector<Imath::V2f> uvs = mesh.uvs;
    std::string error;
    EXPECT_FALSE(unwrap_mesh(mesh, params, nullptr, error));
    EXPECT_EQ(mesh.uvs, uvs);
    return error;
}

} // namespace

TEST(Unwrap, ABoxHasItsSidesUndistorted)
{
    UnwrapReport report;
    expect_atlas(box(V3d(-1), V3d(1, 2, 3), false), atlas_params(256, 4), &report);
    EXPECT_NEAR(report.stretch, 1, 1e-9);
    EXPECT_LE(report.charts, 6);
    EXPECT_GT(report.coverage, 0.55);
}

TEST(Unwrap, ASphereAndMeshesOfTheRealWorld)
{
    UnwrapReport report;
    expect_atlas(sphere(V3d(1, 2, 3), 2, 24), atlas_params(256, 4), &report);
    EXPECT_LT(report.stretch, 1.25);
    EXPECT_GT(report.coverage, 0.5);
    expect_atlas(read_data("spot.obj"), atlas_params(256, 2), &report);
    EXPECT_LT(report.stretch, 1.25);
    EXPECT_GT(report.coverage, 0.55);
    expect_atlas(read_data("gazebo.obj"), atlas_params(512, 2), &report);
    EXPECT_GT(report.coverage, 0.55);
}

TEST(Unwrap, ConvexBodiesSeeEverythingInTheirAtlas)
{
    const UnwrapParams params = atlas_params(128, 2);
    for (const Mesh& body : { box(V3d(-1), V3d(1), false), sphere(V3d(0), 1, 12) }) {
        const BakedMap map(expect_atlas(body, params), {}, bake_params(params));
        int64_t covered = 0;
        map.each_covered([&](const Texel& t, int, int) {
            EXPECT_EQ(t.visibility, 1);
            EXPECT_NEAR(t.direction.length(), 2.0 / 3, 1e-5);
            ++covered;
        });
        EXPECT_GT(covered, 5000);
        EXPECT_EQ(map.report.uv.uncovered_islands, 0);
    }
    const BakedMap inside(expect_atlas(box(V3d(-1), V3d(1), true), params), {}, bake_params(params));
    inside.each_covered([](const Texel& t, int, int) { EXPECT_EQ(t.visibility, 0); });
}

TEST(Unwrap, TheSameForAnyNumberOfThreads)
{
    Mesh one = read_data("spot.obj"), many = one;
    std::string error;
    ASSERT_TRUE(unwrap_mesh(one, atlas_params(256, 4, 1), nullptr, error));
    ASSERT_TRUE(unwrap_mesh(many, atlas_params(256, 4, 5), nullptr, error));
    EXPECT_EQ(mesh_hash(one), mesh_hash(many));
}

TEST(Unwrap, ATriangleFillsTheMapAsFarAsItCan)
{
    Mesh mesh = sheet(1, [](int, int) { return 0; });
    mesh.triangles.resize(1);
    mesh.triangle_materials.resize(1);
    UnwrapReport report;
    expect_atlas(mesh, atlas_params(64, 16), &report);
    EXPECT_EQ(report.charts, 1);
    EXPECT_GT(report.coverage, 0.4);
    // A square that lies flat fills it, whatever the margin.
    expect_atlas(sheet(8, [](int, int) { return 0; }), atlas_params(64, 1000), &report);
    EXPECT_EQ(report.charts, 1);
    EXPECT_GT(report.coverage, 0.9);
}

TEST(Unwrap, AMapThatIsNotSquareHasSquareTexels)
{
    UnwrapReport report;
    expect_atlas(box(V3d(-1), V3d(1), false), { 512, 128, 2, 0 }, &report);
    EXPECT_GT(report.coverage, 0.45);
    expect_atlas(box(V3d(-1), V3d(1), false), { 100, 300, 2, 0 }, &report);
}

TEST(Unwrap, SizeAndPlaceDoNotMatter)
{
    const auto uvs_of = [](double scale, const V3d& move) {
        Mesh mesh = sphere(V3d(0), 1, 8);
        for (V3d& p : mesh.positions)
            p = p * scale + move;
        return expect_atlas(mesh, atlas_params(128, 2)).uvs;
    };
    const std::vector<V2f> uvs = uvs_of(1, V3d(0));
    EXPECT_EQ(uvs_of(0x1p-90, V3d(0)), uvs);
    EXPECT_EQ(uvs_of(0x1p90, V3d(0)), uvs);
    uvs_of(1, V3d(1e6, -1e6, 1e6));
}

TEST(Unwrap, ChartsThatDoNotFitAreRefused)
{
    const Mesh body = box(V3d(-1), V3d(1), false);
    Mesh bodies = body;
    for (const V3d& p : body.positions)
        bodies.positions.push_back(p + V3d(5));
    bodies.normals.insert(bodies.normals.end(), body.normals.begin(), body.normals.end());
    bodies.uvs.insert(bodies.uvs.end(), body.uvs.begin(), body.uvs.end());
    const uint32_t count = uint32_t(body.positions.size());
    for (const auto& [a, b, c] : body.triangles)
        bodies.triangles.push_back({ a + count, b + count, c + count });
    EXPECT_THAT(
        atlas_refusal(bodies, atlas_params(16, 16)),
        testing::EndsWith(" charts do not fit into 16x16 texels with a margin of 16: choose a larger resolution "
                          "or a smaller margin"));
    Mesh none = body;
    none.positions.assign(none.positions.size(), V3d(1, 2, 3));
    EXPECT_EQ(atlas_refusal(none, atlas_params(16, 1)), "\"box\": no triangle has an area: there is nothing to unwrap");
    none.triangles[0][0] = 1000;
    EXPECT_NE(atlas_refusal(none, atlas_params(16, 1)).find("uses vertex 1000"), std::string::npos);
}

TEST(Unwrap, TheReportSaysWhatTheAtlasIsLike)
{
    UnwrapReport report;
    report.charts = 3;
    report.coverage = 0.7123;
    report.density = 12.5;
    report.stretch = 1.0456;
    report.seconds = 0.5;
    EXPECT_EQ(unwrap_line(report, atlas_params(256, 4)),
              "unwrap: 3 charts cover 71.2 % of 256x256 texels, 4 texels apart; 12.5 texels per unit, stretch 1.046; "
              "0.50 s");
    EXPECT_EQ(unwrap_warning(report), "");
    report.without_area = 1;
    report.too_thin = 2;
    EXPECT_EQ(unwrap_warning(report),
              "unwrap: 3 triangles have no area in the atlas: 1 without area in space, 2 thinner than UVs can resolve");
}
