// SPDX-License-Identifier: Apache-2.0
#include "gltf_file.h"

#include <cmath>

using namespace mesh_files;

namespace {

// UVs (1, 0) (0, 1) (1, 1), v down, as integers of any kind.
template <class T> void expect_unit_uvs(const TemporaryFolder& folder, T one)
{
    SCOPED_TRACE(kComponentType<T>);
    GltfFile file = triangle_file();
    const T zero = 0;
    file.primitive()["attributes"]["TEXCOORD_0"]
        = file.add_accessor<T>({ one, zero, zero, one, one, one }, "VEC2", one != T(1));
    Mesh mesh;
    std::string error;
    ASSERT_TRUE(read_mesh(mesh, folder.write("a.gltf", file.text()), {}, error)) << error;
    EXPECT_EQ(mesh.uvs, (std::vector<V2f> { V2f(1, 1), V2f(0, 0), V2f(1, 0) }));
}

using Triangle = std::array<uint32_t, 3>;

} // namespace

TEST_F(MeshFiles, NumbersOfAGltfMayBeOfAnyType)
{
    expect_unit_uvs<int8_t>(folder, 127);
    expect_unit_uvs<uint8_t>(folder, 255);
    expect_unit_uvs<int16_t>(folder, 32767);
    expect_unit_uvs<uint16_t>(folder, 65535);
    expect_unit_uvs<float>(folder, 1);
    expect_unit_uvs<uint8_t>(folder, 1); // not normalized
    expect_unit_uvs<uint32_t>(folder, 1);
}

TEST_F(MeshFiles, TheLeastNormalizedIntegerIsMinusOneToo)
{
    GltfFile file = triangle_file();
    file.primitive()["attributes"]["POSITION"]
        = file.add_accessor<int8_t>({ -128, 0, 0, -127, 127, 0, 0, 64, 0 }, "VEC3", true);
    const Mesh mesh = read("a.gltf", file.text());
    EXPECT_EQ(mesh.positions, (std::vector<V3d> { V3d(-1, 0, 0), V3d(-1, 1, 0), V3d(0, 64 / 127.0, 0) }));
}

TEST_F(MeshFiles, PositionsOfQuantizedMeshesAreIntegers)
{
    GltfFile file = triangle_file();
    file.root["extensionsRequired"] = { "KHR_mesh_quantization" };
    file.primitive()["attributes"]["POSITION"]
        = file.add_accessor<uint16_t>({ 0, 0, 0, 65535, 0, 0, 0, 300, 0 }, "VEC3");
    file.primitive()["attributes"]["NORMAL"]
        = file.add_accessor<int8_t>({ 0, 0, 127, 0, 0, 127, 0, 0, 127 }, "VEC3", true);
    file.root["nodes"][0]["scale"] = { 0.5, 0.5, 0.5 };
    const Mesh mesh = read("a.gltf", file.text());
    EXPECT_EQ(mesh.positions, (std::vector<V3d> { V3d(0, 0, 0), V3d(32767.5, 0, 0), V3d(0, 150, 0) }));
    EXPECT_EQ(mesh.normals, std::vector<V3f>(3, V3f(0, 0, 1)));
    EXPECT_EQ(mesh.normals_from, "from the file");
}

TEST_F(MeshFiles, IndicesOfAGltfMayBeOfAnySize)
{
    const auto corners_by = [&](size_t accessor_of(GltfFile&)) {
        GltfFile file = triangle_file();
        file.primitive()["indices"] = accessor_of(file);
        return read("a.gltf", file.text()).positions;
    };
    const std::vector<V3d> turned { kTriangleCorners[1], kTriangleCorners[2], kTriangleCorners[0] };
    EXPECT_EQ(corners_by([](GltfFile& file) { return file.add_accessor<uint8_t>({ 1, 2, 0 }, "SCALAR"); }), turned);
    EXPECT_EQ(corners_by([](GltfFile& file) { return file.add_accessor<uint16_t>({ 1, 2, 0 }, "SCALAR"); }), turned);
    EXPECT_EQ(corners_by([](GltfFile& file) { return file.add_accessor<uint32_t>({ 1, 2, 0 }, "SCALAR"); }), turned);
    GltfFile none = triangle_file();
    none.primitive().erase("indices");
    EXPECT_EQ(read("a.gltf", none.text()).positions, kTriangleCorners);
}

TEST_F(MeshFiles, AttributesMayBeInterleaved)
{
    GltfFile file = triangle_file();
    // x y z u v of each vertex, 20 bytes, after 4 bytes of something else.
    const size_t view
        = file.add_view(bytes_of<float>({ 9, 0, 0, 0, 1, 0.5f, 2, 0, 0, 0, 0.25f, 0, 3, 0, 0.75f, 0.5f }));
    file.root["bufferViews"][view]["byteStride"] = 20;
    const auto accessor = [&](size_t offset, const char* type) {
        file.root["accessors"].push_back({ { "bufferView", view },
                                           { "byteOffset", offset },
                                           { "componentType", 5126 },
                                           { "count", 3 },
                                           { "type", type } });
        return file.root["accessors"].size() - 1;
    };
    file.primitive()["attributes"] = { { "POSITION", accessor(4, "VEC3") }, { "TEXCOORD_0", accessor(16, "VEC2") } };
    const Mesh mesh = read("a.gltf", file.text());
    EXPECT_EQ(mesh.positions, kTriangleCorners);
    EXPECT_EQ(mesh.uvs, (std::vector<V2f> { V2f(1, 0.5f), V2f(0, 0.75f), V2f(0.75f, 0.5f) }));
}

TEST_F(MeshFiles, StridesNeedNotBeMultiplesOfFour)
{
    GltfFile file = triangle_file();
    const size_t view = file.add_view(std::string("\0\0\0\xff\0\0\0\xff\0", 9));
    file.root["bufferViews"][view]["byteStride"] = 3;
    file.root["accessors"].push_back({ { "bufferView", view },
                                       { "componentType", 5121 },
                                       { "count", 3 },
                                       { "type", "VEC2" },
                                       { "normalized", true } });
    file.primitive()["attributes"]["TEXCOORD_0"] = file.root["accessors"].size() - 1;
    EXPECT_EQ(read("a.gltf", file.text()).uvs, (std::vector<V2f> { V2f(0, 1), V2f(1, 1), V2f(0, 0) }));
}

TEST_F(MeshFiles, SparseAccessorsReplaceSomeElements)
{
    for (const bool has_base : { true, false }) {
        GltfFile file = triangle_file();
        const size_t indices = file.add_view(bytes_of<uint16_t>({ 1, 2 })),
                     values = file.add_view(bytes_of<float>({ 5, 0, 0, 0, 7, 0 }));
        file.accessor(0)["sparse"] = { { "count", 2 },
                                       { "indices", { { "bufferView", indices }, { "componentType", 5123 } } },
                                       { "values", { { "bufferView", values } } } };
        if (!has_base)
            file.accessor(0).erase("bufferView"); // zeros
        const Mesh mesh = read("a.gltf", file.text());
        EXPECT_EQ(mesh.positions, (std::vector<V3d> { V3d(0, 0, 0), V3d(5, 0, 0), V3d(0, 7, 0) }));
    }
}

TEST_F(MeshFiles, AccessorsOutOfRangeAreRefused)
{
    const auto said = [&](const std::function<void(GltfFile&)>& damage) {
        GltfFile file = triangle_file();
        damage(file);
        return refusal(folder.write("a.gltf", file.text()));
    };
    const std::string where = "primitive 0 of mesh \"leaf\": ";
    EXPECT_EQ(said([](GltfFile& f) {
                  f.primitive()["indices"] = f.add_accessor<uint8_t>({ 0, 1, 3 }, "SCALAR");
              }),
              where + "index 2 is vertex 3, but there are only 3");
    EXPECT_EQ(said([](GltfFile& f) { f.primitive()["attributes"]["POSITION"] = 9; }),
              where + "POSITION is accessor 9, but there are only 4");
    EXPECT_EQ(said([](GltfFile& f) { f.accessor(0)["count"] = 4; }),
              where + "POSITION: 4 elements of 12 bytes do not fit buffer view 0, which has 36 bytes");
    EXPECT_EQ(said([](GltfFile& f) { f.accessor(0)["byteOffset"] = 1; }),
              where + "POSITION: 3 elements of 12 bytes do not fit buffer view 0, which has 36 bytes");
    EXPECT_EQ(said([](GltfFile& f) { f.accessor(0)["bufferView"] = 7; }), where + "there is no buffer view 7");
    EXPECT_EQ(said([](GltfFile& f) { f.root["bufferViews"][0]["byteLength"] = 1000; }),
              where + "buffer view 0 is bytes 0 to 1000 of buffer 0, which has 102");
    EXPECT_EQ(said([](GltfFile& f) { f.accessor(2)["count"] = 2; }), where + "TEXCOORD_0 has 2 elements, not 3");
    EXPECT_EQ(said([](GltfFile& f) { f.accessor(2)["type"] = "SCALAR"; }),
              where + "TEXCOORD_0 has elements of 1 number, not 2");
    EXPECT_EQ(said([](GltfFile& f) {
                  f.accessor(0).erase("bufferView");
                  f.accessor(0)["count"] = 1000000000000000;
              }),
              where + "POSITION has 1000000000000000 elements: more than memory holds");
    EXPECT_EQ(said([](GltfFile& f) {
                  const size_t view = f.add_view(bytes_of<float>({ 3, 0, 0, 0 }));
                  f.accessor(0)["sparse"]
                      = { { "count", 1 },
                          { "indices", { { "bufferView", 3 }, { "componentType", 5123 }, { "byteOffset", 4 } } },
                          { "values", { { "bufferView", view } } } };
                  f.accessor(0)["count"] = 2;
                  f.primitive() = { { "attributes", { { "POSITION", 0 } } } };
              }),
              where + "POSITION: sparse element 2 of 2");
}

TEST_F(MeshFiles, StripsAndFansTurnAllTrianglesTheSameWay)
{
    // A square of five corners: strip 0 1 2 3, and fan around corner 4.
    GltfFile file = triangle_file();
    const size_t positions = file.add_accessor<float>({ 0, 0, 0, 1, 0, 0, 0, 1, 0, 1, 1, 0, 0.5f, 0.5f, 0 }, "VEC3");
    file.primitive() = { { "attributes", { { "POSITION", positions } } } };
    file.primitive()["mode"] = 5;
    file.primitive()["indices"] = file.add_accessor<uint8_t>({ 0, 1, 2, 3 }, "SCALAR");
    EXPECT_EQ(area_vector(read("a.gltf", file.text())), V3d(0, 0, 1));
    file.primitive()["mode"] = 6;
    file.primitive()["indices"] = file.add_accessor<uint8_t>({ 4, 0, 1, 3, 2, 0 }, "SCALAR");
    EXPECT_EQ(area_vector(read("a.gltf", file.text())), V3d(0, 0, 1));
    for (int mode = 0; mode <= 3; ++mode) { // points and lines
        file.primitive()["mode"] = mode;
        EXPECT_EQ(refusal(folder.write("a.gltf", file.text())), "no triangles");
    }
    file.primitive()["mode"] = 7;
    EXPECT_EQ(refusal(folder.write("a.gltf", file.text())), "primitive 0 of mesh \"leaf\": unknown mode 7");
}
