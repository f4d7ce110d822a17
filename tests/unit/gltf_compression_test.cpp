// SPDX-License-Identifier: Apache-2.0
#include "gltf_file.h"

#include <cmath>
#include <memory>

#include <draco/compression/encode.h>
#include <draco/mesh/triangle_soup_mesh_builder.h>
#include <meshoptimizer.h>

using namespace mesh_files;

namespace {

std::string text_of(const std::vector<unsigned char>& bytes)
{
    return std::string(bytes.begin(), bytes.end());
}

std::string encode_vertices(const void* vertices, size_t count, size_t stride)
{
    std::vector<unsigned char> bytes(meshopt_encodeVertexBufferBound(count, stride));
    bytes.resize(meshopt_encodeVertexBuffer(bytes.data(), bytes.size(), vertices, count, stride));
    return text_of(bytes);
}

std::string encode_triangles(const std::vector<uint32_t>& indices, size_t vertices)
{
    std::vector<unsigned char> bytes(meshopt_encodeIndexBufferBound(indices.size(), vertices));
    meshopt_encodeIndexVersion(1);
    bytes.resize(meshopt_encodeIndexBuffer(bytes.data(), bytes.size(), indices.data(), indices.size()));
    return text_of(bytes);
}

std::string encode_sequence(const std::vector<uint32_t>& indices, size_t vertices)
{
    std::vector<unsigned char> bytes(meshopt_encodeIndexSequenceBound(indices.size(), vertices));
    bytes.resize(meshopt_encodeIndexSequence(bytes.data(), bytes.size(), indices.data(), indices.size()));
    return text_of(bytes);
}

// Give the view of an accessor compressed bytes in place of its own, which become those of a placeholder.
json& compress(GltfFile& file, size_t accessor, const std::string& bytes, const char* mode, size_t count, size_t stride)
{
    const size_t compressed = file.add_view(bytes);
    json& view = file.root["bufferViews"][size_t(file.accessor(accessor)["bufferView"])];
    view["buffer"] = 1;
    json& extension = view["extensions"]["EXT_meshopt_compression"];
    extension = file.root["bufferViews"][compressed];
    extension["mode"] = mode;
    extension["count"] = count;
    extension["byteStride"] = stride;
    return extension;
}

// The triangle with everything compressed: what gltfpack and gltf-transform write.
GltfFile compressed_file()
{
    GltfFile file = triangle_file();
    file.root["extensionsRequired"] = { "EXT_meshopt_compression" };
    const std::vector<float> positions { 0, 0, 0, 2, 0, 0, 0, 3, 0 }, normals { 0, 0, 1, 0, 0, 1, 0, 0, 1 },
        uvs { 0, 0, 0.5f, 0, 0, 0.25f };
    compress(file, 0, encode_vertices(positions.data(), 3, 12), "ATTRIBUTES", 3, 12);
    compress(file, 1, encode_vertices(normals.data(), 3, 12), "ATTRIBUTES", 3, 12);
    compress(file, 2, encode_vertices(uvs.data(), 3, 8), "ATTRIBUTES", 3, 8);
    compress(file, 3, encode_triangles({ 0, 1, 2 }, 3), "TRIANGLES", 3, 2);
    return file;
}

// With the placeholder as buffer 1.
std::string with_placeholder(const GltfFile& file)
{
    json root = json::parse(file.text());
    root["buffers"].push_back(
        { { "byteLength", 1000 }, { "extensions", { { "EXT_meshopt_compression", { { "fallback", true } } } } } });
    return root.dump();
}

} // namespace

TEST_F(MeshFiles, MeshoptViewsAreDecompressed)
{
    GltfFile file = compressed_file();
    const Mesh plain = read("plain.gltf", triangle_file().text());
    Mesh mesh = read("a.gltf", with_placeholder(file));
    EXPECT_EQ(mesh.positions, plain.positions);
    EXPECT_EQ(mesh.normals, plain.normals);
    EXPECT_EQ(mesh.uvs, plain.uvs);
    EXPECT_EQ(mesh.triangles, plain.triangles);
    const std::vector<uint32_t> turned { 2, 0, 1 };
    compress(file, 3, encode_sequence(turned, 3), "INDICES", 3, 2);
    mesh = read("a.gltf", with_placeholder(file));
    EXPECT_EQ(mesh.positions[0], kTriangleCorners[2]);
}

TEST_F(MeshFiles, MeshoptViewsMayHaveBytesToFallBackOn)
{
    GltfFile file = compressed_file();
    json root = json::parse(with_placeholder(file));
    folder.write("fallback.bin", std::string(1000, '\0')); // not looked at
    root["buffers"][1]["uri"] = "fallback.bin";
    EXPECT_EQ(read("a.gltf", root.dump()).positions, kTriangleCorners);
}

TEST_F(MeshFiles, MeshoptFiltersAreUndone)
{
    GltfFile file = compressed_file();
    // Octahedral normals of 8 bits: +x, -y and +z.
    const float normals[] = { 1, 0, 0, 0, 0, -1, 0, 0, 0, 0, 1, 0 };
    std::vector<int8_t> filtered(12);
    meshopt_encodeFilterOct(filtered.data(), 3, 4, 8, normals);
    compress(file, 1, encode_vertices(filtered.data(), 3, 4), "ATTRIBUTES", 3, 4)["filter"] = "OCTAHEDRAL";
    file.root["bufferViews"][1]["byteStride"] = 4;
    file.accessor(1)["componentType"] = 5120;
    file.accessor(1)["normalized"] = true;
    // Positions as an exponent of 8 bits and a whole number of 24: 1 * 2^2 is 4, 1 * 2^-1 is 0.5.
    const std::vector<uint32_t> exponential { 0, 0, 0, 0x02000001, 0x02000000, 0, 0, 0xff000001, 0xff000000 };
    compress(file, 0, encode_vertices(exponential.data(), 3, 12), "ATTRIBUTES", 3, 12)["filter"] = "EXPONENTIAL";
    const Mesh mesh = read("a.gltf", with_placeholder(file));
    EXPECT_EQ(mesh.positions, (std::vector<V3d> { V3d(0, 0, 0), V3d(4, 0, 0), V3d(0, 0.5, 0) }));
    EXPECT_LT((mesh.normals[0] - V3f(1, 0, 0)).length(), 0.01f);
    EXPECT_LT((mesh.normals[1] - V3f(0, -1, 0)).length(), 0.01f);
    EXPECT_LT((mesh.normals[2] - V3f(0, 0, 1)).length(), 0.01f);
}

TEST_F(MeshFiles, WhatMeshoptWouldAssertIsRefused)
{
    const auto said = [&](const std::function<void(json&)>& damage) {
        GltfFile file = compressed_file();
        damage(file.root["bufferViews"][0]["extensions"]["EXT_meshopt_compression"]);
        return refusal(folder.write("a.gltf", with_placeholder(file)));
    };
    const std::string where = "primitive 0 of mesh \"leaf\": ";
    EXPECT_EQ(
        said([](json& view) { view["byteStride"] = 6; }),
        where
            + "compressed buffer view 0 has count 3 and byteStride 6; ATTRIBUTES needs a byteStride of 4 to 256, a "
              "multiple of 4");
    EXPECT_EQ(
        said([](json& view) {
            view["mode"] = "TRIANGLES";
            view["byteStride"] = 4;
            view["count"] = 4;
        }),
        where
            + "compressed buffer view 0 has count 4 and byteStride 4; TRIANGLES needs a byteStride of 2 or 4 and a "
              "count that is a multiple of 3");
    EXPECT_EQ(said([](json& view) { view["filter"] = "OCTAHEDRAL"; }),
              where + "compressed buffer view 0 has byteStride 12, which the filter OCTAHEDRAL cannot have");
    EXPECT_EQ(said([](json& view) { view["mode"] = "POINTS"; }),
              where + "buffer view 0 is compressed with the unknown mode or filter \"POINTS\"");
    EXPECT_NE(said([](json& view) { view["count"] = 2000000000; }).find("more than its"), std::string::npos);
    EXPECT_NE(said([](json& view) { view["byteLength"] = 4; }).find("is damaged"), std::string::npos);
    EXPECT_NE(said([](json& view) { view["byteOffset"] = 100000; }).find("of a buffer that has"), std::string::npos);
    EXPECT_EQ(said([](json& view) { view["buffer"] = 1; }), where + "buffer 1 has no data: it is a placeholder");
}

namespace {

// The triangle by Draco, lossless, with its attributes in this order: POSITION 0, NORMAL 1, TEXCOORD_0 2.
std::string draco_triangle()
{
    draco::TriangleSoupMeshBuilder builder;
    builder.Start(1);
    const int position = builder.AddAttribute(draco::GeometryAttribute::POSITION, 3, draco::DT_FLOAT32),
              normal = builder.AddAttribute(draco::GeometryAttribute::NORMAL, 3, draco::DT_FLOAT32),
              uv = builder.AddAttribute(draco::GeometryAttribute::TEX_COORD, 2, draco::DT_FLOAT32);
    const float positions[3][3] = { { 0, 0, 0 }, { 2, 0, 0 }, { 0, 3, 0 } }, up[3] = { 0, 0, 1 },
                uvs[3][2] = { { 0, 0 }, { 0.5f, 0 }, { 0, 0.25f } };
    const draco::FaceIndex face(0);
    builder.SetAttributeValuesForFace(position, face, positions[0], positions[1], positions[2]);
    builder.SetAttributeValuesForFace(normal, face, up, up, up);
    builder.SetAttributeValuesForFace(uv, face, uvs[0], uvs[1], uvs[2]);
    const std::unique_ptr<draco::Mesh> mesh = builder.Finalize();
    draco::Encoder encoder;
    encoder.SetEncodingMethod(draco::MESH_SEQUENTIAL_ENCODING);
    draco::EncoderBuffer buffer;
    EXPECT_TRUE(encoder.EncodeMeshToBuffer(*mesh, &buffer).ok());
    return std::string(buffer.data(), buffer.size());
}

GltfFile draco_file()
{
    GltfFile file = triangle_file();
    file.root["extensionsRequired"] = { "KHR_draco_mesh_compression" };
    for (size_t accessor = 0; accessor < 4; ++accessor)
        file.accessor(accessor).erase("bufferView");
    file.primitive()["extensions"]["KHR_draco_mesh_compression"]
        = { { "bufferView", file.add_view(draco_triangle()) },
            { "attributes", { { "POSITION", 0 }, { "NORMAL", 1 }, { "TEXCOORD_0", 2 } } } };
    return file;
}

} // namespace

TEST_F(MeshFiles, DracoPrimitivesAreDecompressed)
{
    const Mesh plain = read("plain.gltf", triangle_file().text());
    for (const int index_type : { 5121, 5123, 5125 }) {
        GltfFile file = draco_file();
        file.accessor(3)["componentType"] = index_type;
        const Mesh mesh = read("a.gltf", file.text());
        EXPECT_EQ(mesh.positions, plain.positions);
        EXPECT_EQ(mesh.normals, plain.normals);
        EXPECT_EQ(mesh.uvs, plain.uvs);
        EXPECT_EQ(area_vector(mesh), area_vector(plain));
    }
}

TEST_F(MeshFiles, DamagedDracoPrimitivesAreRefused)
{
    const auto said = [&](const std::function<void(GltfFile&)>& damage) {
        GltfFile file = draco_file();
        damage(file);
        return refusal(folder.write("a.gltf", file.text()));
    };
    const auto extension
        = [](GltfFile& file) -> json& { return file.primitive()["extensions"]["KHR_draco_mesh_compression"]; };
    const std::string where = "primitive 0 of mesh \"leaf\": ";
    EXPECT_EQ(said([&](GltfFile& f) { extension(f)["attributes"]["POSITION"] = 9; }),
              where + "POSITION is Draco's attribute 9, which does not exist");
    EXPECT_EQ(said([&](GltfFile& f) { extension(f)["attributes"]["TEXCOORD_0"] = 0; }),
              where + "TEXCOORD_0 has elements of 3 numbers, not 2");
    EXPECT_EQ(said([&](GltfFile& f) { extension(f).erase("attributes"); }),
              where + "KHR_draco_mesh_compression has no attributes");
    EXPECT_EQ(said([&](GltfFile& f) { extension(f)["bufferView"] = 77; }), where + "there is no buffer view 77");
    EXPECT_NE(said([&](GltfFile& f) {
                  f.root["bufferViews"][size_t(extension(f)["bufferView"])]["byteLength"] = 20;
              }).find("Draco cannot decode a primitive"),
              std::string::npos);
}

TEST_F(MeshFiles, AttributesThatDracoLeavesOutComeFromTheirAccessors)
{
    GltfFile file = draco_file();
    file.primitive()["extensions"]["KHR_draco_mesh_compression"]["attributes"].erase("TEXCOORD_0");
    file.primitive()["attributes"]["TEXCOORD_0"] = file.add_accessor<float>({ 1, 1, 1, 1, 1, 1 }, "VEC2");
    EXPECT_EQ(read("a.gltf", file.text()).uvs, std::vector<V2f>(3, V2f(1, 0)));
}
