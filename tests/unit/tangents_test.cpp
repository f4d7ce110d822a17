// SPDX-License-Identifier: Apache-2.0
// Tangents where they are known by hand.
#include "scenes.h"

#include <vmlight/mesh/import/read_mesh.h>
#include <vmlight/mesh/tangents.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <map>
#include <string>

using namespace vmlight;
using Imath::V2f;
using Imath::V3d;
using Imath::V3f;

namespace {

void expect_tangent(const CornerTangent& seen, const V3d& direction, float sign, const char* where = "")
{
    EXPECT_LT((V3d(seen.tangent) - direction.normalized()).length(), 1e-6) << where << " " << seen.tangent;
    EXPECT_EQ(seen.sign, sign) << where;
}

// Two triangles on the plane z = 0 that share the edge from (0, 0) to (0, 1), where uv is the position. The corners of
// the edge are 0 and 1 of the first, 1 and 0 of the second.
Mesh two_triangles(const V3d& right, const V2f& right_uv, const V3d& left, const V2f& left_uv)
{
    Mesh mesh;
    mesh.positions = { V3d(0, 0, 0), V3d(0, 1, 0), right, left };
    mesh.uvs = { V2f(0, 0), V2f(0, 1), right_uv, left_uv };
    mesh.normals.assign(4, V3f(0, 0, 1));
    mesh.triangles = { { 0, 2, 1 }, { 1, 3, 0 } };
    return mesh;
}

} // namespace

TEST(Tangents, RunAlongU)
{
    for (const auto& corners : make_tangents(scenes::floor_facing_z(3)))
        for (const CornerTangent& corner : corners)
            expect_tangent(corner, V3d(1, 0, 0), 1);
}

TEST(Tangents, TurnWithTheTextureAndStayPerpendicularToTheNormal)
{
    Mesh mesh = scenes::floor_facing_z(1);
    const double angle = 0.5;
    for (size_t v = 0; v < mesh.uvs.size(); ++v) {
        const V3d& p = mesh.positions[v];
        mesh.uvs[v] = V2f(float(p.x * std::cos(angle) + p.y * std::sin(angle)),
                          float(3 * (p.y * std::cos(angle) - p.x * std::sin(angle))));
    }
    const V3d along(std::cos(angle), std::sin(angle), 0);
    for (const auto& corners : make_tangents(mesh))
        for (const CornerTangent& corner : corners)
            expect_tangent(corner, along, 1);
    const V3d normal = V3d(0.3, -0.2, 1).normalized();
    mesh.normals.assign(mesh.normals.size(), V3f(normal));
    for (const auto& corners : make_tangents(mesh))
        for (const CornerTangent& corner : corners)
            expect_tangent(corner, along - normal * normal.dot(along), 1);
}

TEST(Tangents, AMirroredTextureHasTheOtherSign)
{
    Mesh mesh = scenes::floor_facing_z(1);
    for (V2f& uv : mesh.uvs)
        uv.x = 1 - uv.x;
    for (const auto& corners : make_tangents(mesh))
        for (const CornerTangent& corner : corners)
            expect_tangent(corner, V3d(-1, 0, 0), -1);
}

TEST(Tangents, AreMeansByTheAngles)
{
    // u of the left triangle runs along (1, 1): its third corner is at -1 in u and at the same v as the edge's start.
    const auto tangents = make_tangents(two_triangles(V3d(1, 0, 0), V2f(1, 0), V3d(-1, -1, 0), V2f(-1, 0)));
    const V3d right(1, 0, 0), left = V3d(1, 1, 0).normalized();
    const auto angle = [](const V3d& a, const V3d& b) { return std::acos(a.normalized().dot(b.normalized())); };
    const V3d at_start = right * (M_PI / 2) + left * angle(V3d(0, 1, 0), V3d(-1, -1, 0));
    const V3d at_end = right * (M_PI / 4) + left * angle(V3d(0, -1, 0), V3d(-1, -2, 0));
    expect_tangent(tangents[0][0], at_start, 1, "right, start");
    expect_tangent(tangents[1][2], at_start, 1, "left, start");
    expect_tangent(tangents[0][2], at_end, 1, "right, end");
    expect_tangent(tangents[1][0], at_end, 1, "left, end");
    expect_tangent(tangents[0][1], right, 1, "right alone");
    expect_tangent(tangents[1][1], left, 1, "left alone");
}

TEST(Tangents, SidesOfAMirrorAreNotMixed)
{
    const auto tangents = make_tangents(two_triangles(V3d(1, 0, 0), V2f(1, 0), V3d(-1, 0, 0), V2f(1, 0)));
    for (const CornerTangent& corner : tangents[0])
        expect_tangent(corner, V3d(1, 0, 0), 1);
    for (const CornerTangent& corner : tangents[1])
        expect_tangent(corner, V3d(-1, 0, 0), -1);
}

TEST(Tangents, HardEdgesAndSeamsAreNotMixed)
{
    Mesh mesh = two_triangles(V3d(1, 0, 0), V2f(1, 0), V3d(-1, -1, 0), V2f(-1, 0));
    // The left triangle gets vertices of its own, in another place of the texture.
    for (const uint32_t v : { 0u, 1u }) {
        mesh.positions.push_back(mesh.positions[v]);
        mesh.normals.push_back(mesh.normals[v]);
        mesh.uvs.push_back(mesh.uvs[v] + V2f(5, 0));
    }
    mesh.uvs[3] += V2f(5, 0);
    mesh.triangles[1] = { 5, 3, 4 };
    const auto tangents = make_tangents(mesh);
    for (const CornerTangent& corner : tangents[0])
        expect_tangent(corner, V3d(1, 0, 0), 1);
    for (const CornerTangent& corner : tangents[1])
        expect_tangent(corner, V3d(1, 1, 0), 1);
    // Vertices of their own that are equal are the same vertex.
    for (const size_t v : { 3, 4, 5 })
        mesh.uvs[v] -= V2f(5, 0);
    EXPECT_EQ(make_tangents(mesh)[0][0].tangent, make_tangents(mesh)[1][2].tangent);
    EXPECT_GT(make_tangents(mesh)[0][0].tangent.y, 0.1f);
}

TEST(Tangents, HardTrianglesGiveFiniteOnes)
{
    Mesh mesh = two_triangles(V3d(1, 0, 0), V2f(1, 0), V3d(-1, 0, 0), V2f(-1, 0));
    mesh.positions.push_back(V3d(0, 0, 1e9));
    mesh.normals.push_back(V3f(0));
    mesh.uvs.push_back(V2f(NAN));
    mesh.triangles.insert(mesh.triangles.end(),
                          { { 0, 0, 1 }, { 2, 2, 2 }, { 0, 1, 4 }, { 0, 2, 1 }, { 0, 1, 2 }, { 4, 3, 2 } });
    mesh.uvs[3] = V2f(0, 0.5f); // no area in uv
    for (const auto& corners : make_tangents(mesh))
        for (const CornerTangent& corner : corners) {
            EXPECT_TRUE(std::isfinite(corner.tangent.length())) << corner.tangent;
            EXPECT_LT(corner.tangent.length(), 1.001f);
        }
}

// Corners of gazebo.obj, and of spot.obj with the normals of a sphere, as npm's mikktspace has them.
TEST(Tangents, AreThoseOfMikktspace)
{
    std::ifstream file(VMLIGHT_TEST_DATA "/tangents/mikktspace_corners.txt");
    std::map<std::string, Mesh> meshes;
    std::map<std::string, std::vector<std::array<CornerTangent, 3>>> tangents;
    for (const std::string name : { "gazebo", "spot" }) {
        Mesh& mesh = meshes[name];
        std::string error;
        ASSERT_TRUE(read_mesh(mesh, std::string(VMLIGHT_TEST_DATA "/") + name + ".obj", {}, error)) << error;
        if (name == "spot")
            for (size_t v = 0; v < mesh.positions.size(); ++v)
                mesh.normals[v] = V3f(mesh.positions[v] / mesh.positions[v].length());
        tangents[name] = make_tangents(mesh);
    }
    std::string line, name;
    std::getline(file, line);
    size_t triangle = 0, corner = 0;
    V3f tangent;
    float sign = 0;
    std::vector<float> apart;
    while (file >> name >> triangle >> corner >> tangent.x >> tangent.y >> tangent.z >> sign) {
        const CornerTangent& ours = tangents.at(name).at(triangle).at(corner);
        EXPECT_EQ(ours.sign, sign) << name << " " << triangle << " " << corner;
        apart.push_back((ours.tangent - tangent).length());
    }
    ASSERT_EQ(apart.size(), 537u);
    std::sort(apart.begin(), apart.end());
    // At one corner of spot, with these normals, six triangles' directions nearly cancel, with angles near 0 and 180
    // degrees as weights, which mikktspace has in single precision.
    EXPECT_LT(apart[535], 1e-5f);
    EXPECT_LT(apart[536], 1e-3f);
}
