// SPDX-License-Identifier: Apache-2.0
#include "gltf_file.h"

#include <vmlight/mesh/import/gltf/uri.h>

using namespace mesh_files;

namespace {

// The triangle with its numbers in a file of their own.
std::string with_buffer_at(const std::string& uri)
{
    GltfFile file = triangle_file();
    file.root["buffers"] = { { { "byteLength", file.buffer.size() }, { "uri", uri } } };
    return file.text();
}

} // namespace

TEST_F(MeshFiles, UrisArePercentEncoded)
{
    folder.write("my mesh ä.bin", triangle_file().buffer);
    for (const char* uri : { "my%20mesh%20%C3%A4.bin", "my%20mesh%20%c3%a4.bin", "my mesh ä.bin", "./my mesh ä.bin" })
        EXPECT_EQ(read("a.gltf", with_buffer_at(uri)).triangles.size(), 1u) << uri;
    folder.write("100%.bin", triangle_file().buffer);
    EXPECT_EQ(read("a.gltf", with_buffer_at("100%.bin")).triangles.size(), 1u) << "not encoded";
    EXPECT_EQ(gltf::decode_percent("%41%4a%4A%2z%"), "AJJ%2z%");
}

TEST_F(MeshFiles, FoldersOfUrisMayBeSeparatedByBackslashes)
{
    std::filesystem::create_directories((folder / "sub").c_str());
    folder.write("sub/a.bin", triangle_file().buffer);
    EXPECT_EQ(read("a.gltf", with_buffer_at("sub/a.bin")).triangles.size(), 1u);
    EXPECT_EQ(read("a.gltf", with_buffer_at("sub\\a.bin")).triangles.size(), 1u);
}

TEST_F(MeshFiles, BuffersThatCannotBeReadAreNamed)
{
    const auto said = [&](const std::string& uri) { return refusal(folder.write("a.gltf", with_buffer_at(uri))); };
    const std::string where = "primitive 0 of mesh \"leaf\": ";
    EXPECT_EQ(said("none.bin"), where + "buffer 0: \"" + folder / "none.bin" + "\" does not exist");
    EXPECT_EQ(said("."), where + "buffer 0: \"" + folder / "." + "\" is not a file");
    EXPECT_EQ(
        said("https://example.org/a.bin"),
        where + "buffer 0 is at \"https://example.org/a.bin\": only files beside the mesh can be read, not \"https:\"");
    folder.write("short.bin", triangle_file().buffer.substr(0, 100));
    EXPECT_EQ(said("short.bin"), where + "buffer 0 ends early: 100 bytes of 102");
    folder.write("long.bin", triangle_file().buffer + "more");
    EXPECT_EQ(read("a.gltf", with_buffer_at("long.bin")).triangles.size(), 1u);
    EXPECT_EQ(said("data:application/octet-stream;base64,AAAA"), where + "buffer 0 ends early: 3 bytes of 102");
    EXPECT_EQ(said("data:application/octet-stream;base64,"), where + "buffer 0 has an invalid data URI");
    GltfFile none = triangle_file();
    none.root["buffers"] = { { { "byteLength", 102 } } };
    EXPECT_EQ(refusal(folder.write("a.gltf", none.text())), where + "buffer 0 has no data");
}

TEST_F(MeshFiles, DataUrisMayHaveAnyMediaTypeOrNoBase64)
{
    const std::string buffer = triangle_file().buffer;
    std::string percent;
    for (const char c : buffer)
        percent += OIIO::Strutil::sprintf("%%%02x", unsigned(uint8_t(c)));
    for (const std::string& uri :
         { "data:;base64," + base64(buffer), "data:model/gltf-buffer;base64," + base64(buffer),
           "data:application/octet-stream;charset=x;base64," + base64(buffer), "data:," + percent })
        EXPECT_EQ(read("a.gltf", with_buffer_at(uri)).positions[2], V3d(0, 3, 0)) << uri.substr(0, 40);
}

TEST_F(MeshFiles, JsonMayStartWithAByteOrderMarkAndHoldBadUtf8)
{
    GltfFile file = triangle_file();
    EXPECT_EQ(read("a.gltf", "\xef\xbb\xbf" + file.text()).triangles.size(), 1u);
    const std::string latin = OIIO::Strutil::replace(file.text(), "leaf", "Bl\xe4tt");
    EXPECT_EQ(read("a.gltf", latin).triangles.size(), 1u);
    EXPECT_EQ(read("a.gltf", "  \n" + file.text() + "\n").triangles.size(), 1u);
}

TEST_F(MeshFiles, RequiredExtensionsThatAreNotReadAreRefused)
{
    GltfFile file = triangle_file();
    file.root["extensionsUsed"] = { "KHR_texture_transform", "KHR_materials_unlit", "EX_bends", "KHR_lights_punctual" };
    file.root["extensionsRequired"] = { "KHR_texture_transform", "KHR_materials_unlit" };
    const Mesh mesh = read("a.gltf", file.text());
    EXPECT_EQ(mesh.warnings,
              (std::vector<std::string> {
                  "uses the extension EX_bends, which vmlight does not read: the geometry may differ" }));
    file.root["extensionsRequired"] = { "EX_bends" };
    EXPECT_EQ(refusal(folder.write("a.gltf", file.text())),
              "requires the extension EX_bends, which vmlight does not read: export the mesh without it");
    file.root["extensionsRequired"] = { "EX_bends", "KHR_meshopt_compression", "EX_bends" };
    EXPECT_EQ(refusal(folder.write("a.gltf", file.text())),
              "requires the extensions EX_bends, KHR_meshopt_compression, which vmlight does not read: export the mesh "
              "without them");
    file.root.erase("extensionsRequired");
    file.root["extensionsUsed"] = { "KHR_meshopt_compression" };
    EXPECT_TRUE(read("a.gltf", file.text()).warnings.empty()) << "the file holds the same without it";
}

TEST_F(MeshFiles, OtherVersionsOfGltfAreRefused)
{
    GltfFile file = triangle_file();
    const auto said = [&] { return refusal(folder.write("a.gltf", file.text())); };
    file.root["asset"]["version"] = "1.1";
    EXPECT_EQ(said(), "glTF version 1.1; supported: 2.0");
    file.root["asset"] = { { "version", "2.1" }, { "minVersion", "2.1" } };
    EXPECT_EQ(said(), "needs a reader of glTF 2.1; supported: 2.0");
    file.root["asset"] = { { "version", "2.1" } };
    EXPECT_EQ(read("a.gltf", file.text()).triangles.size(), 1u);
    file.root["asset"] = { { "generator", "me" } };
    EXPECT_EQ(said(), "has no asset.version");
    EXPECT_EQ(refusal(folder.write("a.gltf", "{\"asset\": ]")).substr(0, 13), "invalid JSON:");
    file = triangle_file();
    file.root["nodes"] = 7;
    EXPECT_NE(said(), "");
    file = triangle_file();
    file.root["accessors"] = { 7 };
    EXPECT_EQ(said(), "0 of \"accessors\" is not an object");
}

TEST_F(MeshFiles, QuantizedUvsAreScaledBackByTheirTextures)
{
    GltfFile file = triangle_file();
    file.root["textures"] = { { { "source", 0 } } };
    file.root["materials"]
        = { { { "pbrMetallicRoughness",
                { { "baseColorTexture",
                    { { "index", 0 },
                      { "extensions",
                        { { "KHR_texture_transform",
                            { { "offset", { 0.5, 0 } }, { "scale", { 1 / 64.0, 1 / 128.0 } } } } } } } } } } } };
    file.root["images"] = { { { "uri", "data:image/png;base64,AAAA" } } };
    file.primitive()["material"] = 0;
    const auto uvs_of = [&](size_t accessor) {
        file.primitive()["attributes"]["TEXCOORD_0"] = accessor;
        return read("a.gltf", file.text());
    };
    const std::vector<V2f> restored { V2f(0.5f, 1), V2f(0.75f, 1), V2f(0.5f, 0.5f) };
    const size_t integers = file.add_accessor<uint16_t>({ 0, 0, 16, 0, 0, 64 }, "VEC2");
    Mesh mesh = uvs_of(integers);
    EXPECT_EQ(mesh.uvs, restored);
    EXPECT_TRUE(mesh.warnings.empty());

    // Normalized ones are UVs as they are, but of gltfpack.
    const size_t normalized = file.add_accessor<uint8_t>({ 0, 0, 255, 0, 0, 255 }, "VEC2", true);
    mesh = uvs_of(normalized);
    EXPECT_EQ(mesh.uvs, (std::vector<V2f> { V2f(0, 1), V2f(1, 1), V2f(0, 0) }));
    ASSERT_EQ(mesh.warnings.size(), 1u);
    EXPECT_NE(mesh.warnings[0].find("KHR_texture_transform"), std::string::npos);
    file.root["asset"]["generator"] = "gltfpack 0.18";
    EXPECT_EQ(uvs_of(normalized).uvs, (std::vector<V2f> { V2f(0.5f, 1), V2f(0.515625f, 1), V2f(0.5f, 0.9921875f) }));

    // Of floats the texture moves, not the layout.
    mesh = uvs_of(2);
    EXPECT_EQ(mesh.uvs[1], V2f(0.5f, 1));
    EXPECT_EQ(mesh.warnings.size(), 1u);

    // Without a transform nothing can undo it.
    file.primitive().erase("material");
    mesh = uvs_of(integers);
    EXPECT_TRUE(mesh.uvs.empty());
    EXPECT_EQ(mesh.warnings,
              (std::vector<std::string> { "UV set 0 is of integers that nothing scales back to [0, 1], and "
                                          "is not read: write it as floats (gltfpack: -vtf)" }));
}
