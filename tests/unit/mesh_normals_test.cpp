// SPDX-License-Identifier: Apache-2.0
#include "scenes.h"

#include <vmlight/math/latlong.h>

#include <gtest/gtest.h>

#include <set>

using namespace vmlight;
using namespace vmlight::scenes;

namespace {

// A cube of eight vertices without normals.
Mesh bare_cube(double size = 1)
{
    Mesh mesh = placed(box(V3d(-1), V3d(1), false), size);
    mesh.normals.assign(mesh.positions.size(), V3f(0));
    mesh.uvs.clear();
    merge_equal_vertices(mesh);
    return mesh;
}

// The greatest angle between a made normal and the one that is right, in degrees.
double worst_angle(const Mesh& mesh, const Mesh& truth_mesh)
{
    double worst = 0;
    for (size_t t = 0; t < mesh.triangles.size(); ++t)
        for (int k = 0; k < 3; ++k) {
            const V3d a(mesh.normals[mesh.triangles[t][k]]), b(truth_mesh.normals[truth_mesh.triangles[t][k]]);
            worst = std::max(worst, std::atan2(a.cross(b).length(), a.dot(b)) * 180 / M_PI);
        }
    return worst;
}

} // namespace

TEST(MeshNormals, ACubesSmoothNormalsPointOutOfItsCorners)
{
    for (double size : { 1.0, 1e-6, 1e6 }) {
        Mesh cube = bare_cube(size);
        ASSERT_EQ(cube.positions.size(), 8u);
        make_smooth_normals(cube, 180);
        EXPECT_EQ(cube.positions.size(), 8u);
        for (size_t v = 0; v < 8; ++v) // whichever way the faces are cut: weights are angles
            EXPECT_LT((V3d(cube.normals[v]) - cube.positions[v].normalized()).length(), 1e-6) << size;
    }
}

TEST(MeshNormals, ACubesCreasedNormalsAreItsFaces)
{
    for (double crease : { 0.0, 30.0, 89.9 }) {
        Mesh cube = bare_cube();
        make_smooth_normals(cube, crease);
        EXPECT_EQ(cube.positions.size(), 24u) << crease;
        for (const auto& t : cube.triangles)
            for (uint32_t v : t)
                EXPECT_LT((V3d(cube.normals[v]) - triangle_area_normal(cube, t).normalized()).length(), 1e-6);
    }
    Mesh cube = bare_cube();
    make_smooth_normals(cube, 90); // edges of exactly 90 degrees meet at no more than 90
    EXPECT_EQ(cube.positions.size(), 8u);
}

TEST(MeshNormals, FlatNormalsAreTheTriangles)
{
    Mesh ball = icosphere(2);
    make_flat_normals(ball);
    for (const auto& t : ball.triangles)
        for (uint32_t v : t)
            EXPECT_LT((V3d(ball.normals[v]) - triangle_area_normal(ball, t).normalized()).length(), 1e-6);
    EXPECT_EQ(ball.positions.size(), 3 * ball.triangles.size());
}

TEST(MeshNormals, SmoothNormalsOfABallPointOut)
{
    const Mesh truth = icosphere(3);
    Mesh ball = truth;
    make_smooth_normals(ball, 180);
    EXPECT_LT(worst_angle(ball, truth), 0.5);
    const Mesh rings = sphere(V3d(3, 4, 5), 2, 24);
    ball = rings;
    make_smooth_normals(ball, 180);
    EXPECT_LT(worst_angle(ball, rings), 1.5); // quads of unequal sides
}

TEST(MeshNormals, SeamsOfTheTextureDoNotShow)
{
    // Vertices at the seam have two texture coordinates and one position: they share their normal, and stay two.
    Mesh ball = sphere(V3d(0), 1, 12);
    const size_t with_normals = ball.positions.size();
    make_smooth_normals(ball, 180);
    std::set<std::array<double, 3>> positions, normals;
    for (const auto& t : ball.triangles)
        for (uint32_t v : t) {
            positions.insert({ ball.positions[v].x, ball.positions[v].y, ball.positions[v].z });
            normals.insert({ ball.positions[v].x + 10 * ball.normals[v].x, ball.positions[v].y + 10 * ball.normals[v].y,
                             ball.positions[v].z + 10 * ball.normals[v].z });
        }
    EXPECT_EQ(normals.size(), positions.size());
    EXPECT_GT(ball.positions.size(), positions.size());
    EXPECT_LE(ball.positions.size(), with_normals);
}

TEST(MeshNormals, MinusZeroIsTheSamePlaceAsZero)
{
    Mesh roof;
    add_quad(roof, V3d(-1, 0, -1), V3d(-1, 2, -1), V3d(-0.0, 2, 0), V3d(-0.0, 0, 0));
    add_quad(roof, V3d(0.0, 0, 0), V3d(0.0, 2, 0), V3d(1, 2, -1), V3d(1, 0, -1));
    make_smooth_normals(roof, 180);
    for (const auto& t : roof.triangles)
        for (uint32_t v : t)
            if (roof.positions[v].x == 0) {
                EXPECT_NEAR(roof.normals[v].x, 0, 1e-6f);
            }
}

TEST(MeshNormals, OnlyMissingNormalsAreMade)
{
    Mesh mesh = floor_facing_z(1);
    mesh.normals[0] = V3f(1, 0, 0);
    mesh.normals[1] = V3f(0);
    mesh.normals[2] = V3f(NAN, 0, 1);
    fill_missing_normals(mesh, 180);
    ASSERT_EQ(mesh.positions.size(), 4u);
    for (size_t v = 0; v < 4; ++v)
        EXPECT_EQ(mesh.normals[v], mesh.positions[v] == V3d(-1, -1, 0) ? V3f(1, 0, 0) : V3f(0, 0, 1));
}

TEST(MeshNormals, FacesBackToBackKeepTheirOwn)
{
    Mesh sheet;
    const V3d a(0, 0, 0), b(1, 0, 0), c(1, 1, 0.3), d(0, 1, 0.3);
    add_quad(sheet, a, b, c, d);
    add_quad(sheet, d, c, b, a);
    make_smooth_normals(sheet, 180);
    for (const auto& t : sheet.triangles)
        for (uint32_t v : t)
            EXPECT_LT((V3d(sheet.normals[v]) - triangle_area_normal(sheet, t).normalized()).length(), 1e-5);
}

TEST(MeshNormals, SharpSeamsOfUvsAreHardIfAsked)
{
    // Two triangles that meet in the edge from 0 to 1 (as vertices 3 and 4 with other uvs), at an angle.
    const auto fold = [](double degrees) {
        const double angle = degrees * latlong::pi / 180;
        Mesh mesh;
        mesh.positions = { V3d(0, 0, 0), V3d(1, 0, 0), V3d(0, -1, 0),
                           V3d(0, 0, 0), V3d(1, 0, 0), V3d(0, std::cos(angle), std::sin(angle)) };
        mesh.uvs = { V2f(0, 0), V2f(1, 0), V2f(0, 1), V2f(0.5f, 0), V2f(0.5f, 1), V2f(0, 0.5f) };
        mesh.triangles = { { 0, 2, 1 }, { 3, 4, 5 } };
        mesh.normals.assign(6, V3f(0));
        return mesh;
    };
    const auto turn = [](const Mesh& mesh) {
        double most = 0;
        for (const auto& triangle : mesh.triangles)
            for (const uint32_t vertex : triangle) {
                const V3d flat = triangle_area_normal(mesh, triangle).normalized();
                most = std::max(most, (V3d(mesh.normals[vertex]) - flat).length());
            }
        return most;
    };
    for (const double degrees : { 50.0, 70.0 }) {
        Mesh mesh = fold(degrees);
        fill_missing_normals(mesh, 180, {}, 60);
        const double half = 2 * std::sin(degrees * latlong::pi / 720);
        EXPECT_NEAR(turn(mesh), degrees > 60 ? 0 : half, 1e-6) << degrees;
        mesh = fold(degrees);
        fill_missing_normals(mesh, 180);
        EXPECT_NEAR(turn(mesh), half, 1e-6) << "smooth unless asked";
        mesh = fold(degrees);
        mesh.uvs[3] = mesh.uvs[0];
        mesh.uvs[4] = mesh.uvs[1];
        fill_missing_normals(mesh, 180, {}, 60);
        EXPECT_NEAR(turn(mesh), half, 1e-6) << "no seam";
    }
}

TEST(MeshNormals, TrianglesWithoutAreaDoNotSpoilTheirNeighbours)
{
    Mesh mesh = floor_facing_z(1);
    const uint32_t first = uint32_t(mesh.positions.size());
    for (double x : { -1.0, 0.0, 1.0 })
        mesh.positions.push_back(V3d(x, 1, 0)); // along the floor's far side
    mesh.positions.push_back(V3d(7, 7, 7));
    mesh.normals.resize(mesh.positions.size());
    mesh.uvs.resize(mesh.positions.size());
    mesh.triangles.push_back({ first, first + 1, first + 2 });
    mesh.triangles.push_back({ first + 3, first + 3, first + 3 });
    mesh.triangle_materials.resize(4);
    make_smooth_normals(mesh, 180);
    for (size_t v = 0; v < mesh.positions.size(); ++v)
        if (mesh.positions[v] == V3d(7) || mesh.positions[v] == V3d(0, 1, 0))
            EXPECT_EQ(mesh.normals[v], V3f(0)); // nothing to make it of
        else
            EXPECT_LT((mesh.normals[v] - V3f(0, 0, 1)).length(), 1e-6f);
}

TEST(MeshNormals, VerticesMergeIfAllTheirBitsAgree)
{
    Mesh mesh = floor_facing_z(1);
    append(mesh, floor_facing_z(1));
    ASSERT_EQ(mesh.positions.size(), 8u);
    mesh.uvs[5].x += 1e-7f;
    mesh.normals[6].x = 1e-7f;
    mesh.positions[7].x += 1e-15;
    const Mesh before = mesh;
    merge_equal_vertices(mesh);
    EXPECT_EQ(mesh.positions.size(), 7u);
    EXPECT_EQ(mesh.normals.size(), 7u);
    EXPECT_EQ(mesh.uvs.size(), 7u);
    for (size_t t = 0; t < mesh.triangles.size(); ++t)
        for (int k = 0; k < 3; ++k) {
            const uint32_t v = mesh.triangles[t][k], old = before.triangles[t][k];
            EXPECT_EQ(mesh.positions[v], before.positions[old]);
            EXPECT_EQ(mesh.normals[v], before.normals[old]);
            EXPECT_EQ(mesh.uvs[v], before.uvs[old]);
        }
    const Mesh once = mesh;
    merge_equal_vertices(mesh);
    EXPECT_EQ(mesh.triangles, once.triangles);
}

TEST(MeshNormals, VerticesThatAreNotNumbersMergeToo)
{
    Mesh mesh = floor_facing_z(1);
    append(mesh, floor_facing_z(1));
    for (V2f& uv : mesh.uvs)
        uv = V2f(NAN, NAN);
    merge_equal_vertices(mesh);
    EXPECT_EQ(mesh.positions.size(), 4u);
}

TEST(MeshHash, IsStableAndTellsMeshesApart)
{
    const Mesh mesh = floor_facing_z(1);
    const std::string hash = mesh_hash(mesh);
    EXPECT_EQ(hash.size(), 16u);
    EXPECT_EQ(hash.find_first_not_of("0123456789abcdef"), std::string::npos);
    EXPECT_EQ(mesh_hash(floor_facing_z(1)), hash);
    EXPECT_EQ(hash, "8c0e67159a09d1fd"); // the same on every machine and in every version: maps carry it
    std::set<std::string> hashes { hash };
    const auto expect_new = [&](const auto& change) {
        Mesh changed = mesh;
        change(changed);
        EXPECT_TRUE(hashes.insert(mesh_hash(changed)).second);
    };
    expect_new([](Mesh& m) { m.positions[2].z = 1e-300; });
    expect_new([](Mesh& m) { m.normals[2].z = 0.5f; });
    expect_new([](Mesh& m) { m.uvs[2].x = 0.5f; });
    expect_new([](Mesh& m) { m.uvs.clear(); });
    expect_new([](Mesh& m) { std::swap(m.triangles[0], m.triangles[1]); });
    expect_new([](Mesh& m) { m.triangles.pop_back(); });
    expect_new([](Mesh& m) { m = Mesh(); });
    Mesh renamed = mesh;
    renamed.name = "other";
    renamed.triangle_materials.set(0, 7);
    EXPECT_EQ(mesh_hash(renamed), hash); // neither is geometry
}
