// SPDX-License-Identifier: Apache-2.0
// glTF files as programs write them, and as nobody should. The box is that of tests/data/cases.
#include "gltf_file.h"
#include "hard_case.h"
#include "mesh_refusal.h"

#include <vmlight/base/format.h>

#include <algorithm>
#include <cmath>
#include <functional>

using namespace mesh_files;

namespace {

std::string case_path(const char* name)
{
    return std::string(VMLIGHT_TEST_DATA) + "/cases/" + name;
}

Mesh read_case(const char* name)
{
    Mesh mesh;
    std::string error;
    EXPECT_TRUE(read_mesh(mesh, case_path(name), {}, error)) << error;
    return mesh;
}

// How far the corners of a mesh are from those of another that has the same triangles in the same order.
double farthest(const Mesh& a, const Mesh& b)
{
    double distance = a.triangles.size() == b.triangles.size() ? 0 : HUGE_VAL;
    for (size_t t = 0; t < a.triangles.size() && distance < HUGE_VAL; ++t)
        for (size_t k = 0; k < 3; ++k)
            distance = std::max(distance, (a.positions[a.triangles[t][k]] - b.positions[b.triangles[t][k]]).length());
    return distance;
}

// Of each corner's normal from that of its triangle.
double greatest_turn(const Mesh& mesh)
{
    double turn = 0;
    for (const auto& triangle : mesh.triangles)
        for (const uint32_t vertex : triangle)
            turn = std::max(turn,
                            (V3d(mesh.normals[vertex]) - triangle_area_normal(mesh, triangle).normalized()).length());
    return turn;
}

} // namespace

TEST(Geometry, GltfsThatAreCompressed)
{
    HardCase row("A box in a glTF: Draco with 32-bit indices, UVs of 8 and 16 bits, two instances");
    row.naive("assimp 5.2: refused, an empty map, one instance (measured)");
    const Mesh box = read_case("box.obj");
    EXPECT_NEAR(area(read_case("draco_32.glb")), area(box), 1e-3);
    for (const char* name : { "g_uv8.glb", "g_uv16.glb" }) {
        const Mesh mesh = read_case(name);
        ASSERT_FALSE(mesh.uvs.empty());
        EXPECT_EQ(farthest(mesh, box), 0) << name;
    }
    EXPECT_NEAR(area(read_case("g_inst.glb")), 2 * area(box), 1e-9);
    row.ours("the box, its UVs to 8 and 16 bits; both instances");
}

TEST(Geometry, GltfsThatArePosed)
{
    HardCase row("A box in a glTF: joints shrink it and its own node would turn it; a morph target raises it");
    row.naive("assimp 5.2: turned and a hundred times as large; flat on the floor (measured)");
    const Mesh box = read_case("box.obj");
    EXPECT_LT(farthest(read_case("g_skin.glb"), box), 1e-6);
    EXPECT_LT(farthest(read_case("g_morph.glb"), box), 1e-6);
    row.ours("the box");
}

TEST(Geometry, GltfsWithoutNormals)
{
    HardCase row("A box in a glTF without normals");
    row.naive("smoothed over all edges: mean V .848 instead of .778 (measured)");
    EXPECT_LT(greatest_turn(read_case("g_nonormal.glb")), 1e-6);
    EXPECT_LT(greatest_turn(read_case("g_mirror_nonormal.glb")), 1e-6) << "under a mirroring node";
    row.ours("flat, as the format says");
}

TEST(Geometry, GltfsThatRequireTheUnknown)
{
    HardCase row("A glTF that requires an extension which nobody has heard of");
    row.naive("read without it, exit 0 (measured)");
    Mesh mesh;
    std::string error;
    EXPECT_FALSE(read_mesh(mesh, case_path("g_unknownreq.gltf"), {}, error));
    EXPECT_EQ(
        error,
        "\"" + case_path("g_unknownreq.gltf")
            + "\": "
              "requires the extension XX_unknown_geometry, which vmlight does not read: export the mesh without it");
    row.ours("refused, with its name");
}

TEST(Geometry, GltfsThatClaimTooMuch)
{
    HardCase row("A glTF whose accessor, index, buffer view or compressed view claims more than the file holds");
    row.naive("reads past the end; asks for 400 kB for 24 bytes");
    const TemporaryFolder folder;
    const auto said = [&](const std::function<void(GltfFile&)>& damage) {
        GltfFile file = triangle_file();
        damage(file);
        return refusal(folder, "a.gltf", file.text());
    };
    const std::string where = "primitive 0 of mesh \"leaf\": ";
    EXPECT_EQ(said([](GltfFile& f) {
                  f.accessor(0)["count"] = 4;
                  f.accessor(1)["count"] = 4;
                  f.accessor(2)["count"] = 4;
              }),
              where + "POSITION: 4 elements of 12 bytes do not fit buffer view 0, which has 36 bytes");
    EXPECT_EQ(said([](GltfFile& f) {
                  f.primitive()["indices"] = f.add_accessor<uint8_t>({ 0, 1, 3 }, "SCALAR");
              }),
              where + "index 2 is vertex 3, but there are only 3");
    EXPECT_EQ(said([](GltfFile& f) { f.root["bufferViews"][0]["byteLength"] = 5000; }),
              where + "buffer view 0 is bytes 0 to 5000 of buffer 0, which has 102");
    EXPECT_EQ(said([](GltfFile& f) {
                  f.root["bufferViews"][0]["extensions"]["EXT_meshopt_compression"] = { { "buffer", 0 },
                                                                                        { "byteLength", 24 },
                                                                                        { "byteStride", 4 },
                                                                                        { "count", 100000 },
                                                                                        { "mode", "ATTRIBUTES" } };
              }),
              where + "compressed buffer view 0 claims 100000 elements of 4 bytes, more than its 24 bytes can hold");
    row.ours("refused, with the numbers");
}
