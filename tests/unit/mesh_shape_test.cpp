// SPDX-License-Identifier: Apache-2.0
// By what a mesh is known in another format, or written by another program.
#include "mesh_fixture.h"
#include "scenes.h"

#include <vmlight/mesh/export/write_mesh.h>
#include <vmlight/mesh/instances.h>
#include <vmlight/mesh/shape.h>

#include <cmath>
#include <functional>

using namespace vmlight;
using namespace mesh_files;

namespace {

using MeshShapes = MeshFiles;

Mesh round_ball(const V3d& place = V3d(0), int segments = 24)
{
    Mesh mesh = scenes::sphere(place, 1, segments);
    mesh.name = "ball";
    for (V3f& n : mesh.normals)
        n = n.normalized();
    return mesh;
}

// As another program may write it, from the last triangle to the first and each with vertices of its own.
Mesh turned_over(const Mesh& mesh)
{
    Mesh other;
    other.name = mesh.name;
    for (auto triangle = mesh.triangles.rbegin(); triangle != mesh.triangles.rend(); ++triangle) {
        const auto first = uint32_t(other.positions.size());
        for (const uint32_t v : *triangle) {
            other.positions.push_back(mesh.positions[v]);
            other.normals.push_back(mesh.normals[v]);
            other.uvs.push_back(mesh.uvs[v]);
        }
        other.triangles.push_back({ first + 1, first + 2, first });
    }
    return other;
}

} // namespace

TEST_F(MeshShapes, OfASphereAreItsMoments)
{
    const V3d place(3, -2, 1);
    const Mesh mesh = scenes::sphere(place, 2, 400); // in several blocks
    ASSERT_GT(mesh.triangles.size(), size_t(1) << 17);
    const std::vector<std::string> words = OIIO::Strutil::splits(mesh_shape(mesh), " ");
    ASSERT_EQ(words.size(), 22u);
    int threads = 0;
    OIIO::getattribute("threads", threads);
    OIIO::attribute("threads", 1);
    EXPECT_EQ(OIIO::Strutil::splits(mesh_shape(mesh), " "), words);
    OIIO::attribute("threads", threads);
    const auto number = [&](size_t i) { return std::stod(words[i]); };
    EXPECT_EQ(number(0), double(mesh.triangles.size()));
    EXPECT_NEAR(number(1), 2, 1e-3);
    for (int axis = 0; axis < 3; ++axis) {
        EXPECT_NEAR(number(2 + size_t(axis)), place[axis], 1e-3);
        EXPECT_NEAR(number(6 + size_t(axis)), 1 / 3.0, 1e-3);
    }
    EXPECT_NEAR(number(5), 4 * M_PI, 1e-2);
    for (size_t axis = 17; axis < 20; ++axis)
        EXPECT_NEAR(number(axis), 0, 1e-3) << "of normals";
    EXPECT_NEAR(number(20), 1, 1e-3) << "they point outwards";
    EXPECT_NEAR(number(21), 1, 1e-3) << "as those of faces do";
}

TEST_F(MeshShapes, AreThoseOfTheMeshThatWasWritten)
{
    for (const V3d& place : { V3d(0), V3d(84900.3, 12.7, 447600.1) }) {
        const Mesh mesh = round_ball(place);
        const std::string shape = mesh_shape(mesh);
        EXPECT_TRUE(same_shape(shape, mesh_shape(turned_over(mesh))));
        for (const char* name : { "a.obj", "a.glb" }) {
            std::string error;
            ASSERT_TRUE(write_mesh(mesh, folder / name, error)) << error;
            EXPECT_TRUE(same_shape(shape, mesh_shape(read(folder / name)))) << name << "\n" << shape;
        }
    }
    Mesh rounded = round_ball();
    for (V3d& p : rounded.positions) // as Blender's six digits do
        for (int axis = 0; axis < 3; ++axis)
            p[axis] = std::round(p[axis] * 1e6) / 1e6;
    EXPECT_TRUE(same_shape(mesh_shape(round_ball()), mesh_shape(rounded)));
}

TEST_F(MeshShapes, DifferByWhatAMapDependsOn)
{
    const std::map<std::string, std::function<void(Mesh&)>> changes {
        { "moved",
          [](Mesh& m) {
              for (V3d& p : m.positions)
                  p.x += 1e-3;
          } },
        { "scaled",
          [](Mesh& m) {
              for (V3d& p : m.positions)
                  p *= 1.001;
          } },
        { "half a turn",
          [](Mesh& m) {
              for (V3d& p : m.positions)
                  p = V3d(-p.x, p.y, -p.z);
          } },
        { "a dent", [](Mesh& m) { m.positions[m.positions.size() / 2] *= 0.9; } },
        { "u and v exchanged",
          [](Mesh& m) {
              for (V2f& uv : m.uvs)
                  uv = V2f(uv.y, uv.x);
          } },
        { "u mirrored",
          [](Mesh& m) {
              for (V2f& uv : m.uvs)
                  uv.x = 1 - uv.x;
          } },
        { "flat", make_flat_normals },
        { "inside out",
          [](Mesh& m) {
              for (auto& triangle : m.triangles)
                  std::swap(triangle[1], triangle[2]);
              for (V3f& n : m.normals)
                  n = -n;
          } },
        { "a triangle fewer", [](Mesh& m) { m.triangles.pop_back(); } },
    };
    const std::string shape = mesh_shape(round_ball());
    for (const auto& [name, change] : changes) {
        Mesh mesh = round_ball();
        change(mesh);
        EXPECT_FALSE(same_shape(shape, mesh_shape(mesh))) << name << "\n" << shape << "\n" << mesh_shape(mesh);
    }
}

TEST_F(MeshShapes, OfNothingAreLikeNone)
{
    Mesh mesh = round_ball();
    mesh.instances = std::make_shared<MeshInstances>();
    EXPECT_EQ(mesh_shape(mesh), "");
    mesh = round_ball();
    for (V3d& p : mesh.positions)
        p = V3d(1);
    EXPECT_EQ(mesh_shape(mesh), "") << "no area";
    const std::string shape = mesh_shape(round_ball());
    EXPECT_FALSE(same_shape("", ""));
    EXPECT_FALSE(same_shape(shape, shape + " 1"));
    EXPECT_FALSE(same_shape(shape, "x" + shape.substr(1)));
    EXPECT_FALSE(same_shape(shape, "nan" + shape.substr(shape.find(' '))));
}
