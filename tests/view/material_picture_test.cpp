// SPDX-License-Identifier: Apache-2.0
// Materials: their textures and alpha, against the renderer of vmframes.
#include "view_pictures.h"

#include "gltf_file.h"
#include "temporary_folder.h"

using namespace vmlight;
using namespace vmlight::view;
using namespace mesh_files;

namespace {

using MaterialPicture = HeadlessPicture;

// Squares one behind the other, each beside the one before in UV: what is in front is cut out or blended.
GltfFile three_cards()
{
    GltfFile file;
    json primitives = json::array();
    for (int card = 0; card < 3; ++card) {
        const float z = float(-card), x = 0.3f * float(card), u = float(card) / 3;
        const size_t positions
            = file.add_accessor<float>({ x - 1, -1, z, x + 1, -1, z, x + 1, 1, z, x - 1, 1, z }, "VEC3");
        const size_t normals = file.add_accessor<float>({ 0, 0, 1, 0, 0, 1, 0, 0, 1, 0, 0, 1 }, "VEC3");
        const float left = u + 0.02f, right = u + 0.31f;
        const size_t uvs = file.add_accessor<float>({ left, 0.98f, right, 0.98f, right, 0.02f, left, 0.02f }, "VEC2");
        const size_t indices = file.add_accessor<uint16_t>({ 0, 1, 2, 0, 2, 3 }, "SCALAR");
        file.accessor(positions)["min"] = { x - 1, -1, z };
        file.accessor(positions)["max"] = { x + 1, 1, z };
        primitives.push_back(
            { { "attributes", { { "POSITION", positions }, { "NORMAL", normals }, { "TEXCOORD_0", uvs } } },
              { "indices", indices },
              { "material", card } });
    }
    file.root["meshes"] = json::array({ json { { "primitives", primitives } } });
    return file;
}

// Blocks of colors, with holes in the alpha.
void write_texture(const std::string& path)
{
    OIIO::ImageBuf image(OIIO::ImageSpec(16, 8, 4, OIIO::TypeDesc::FLOAT));
    for (OIIO::ImageBuf::Iterator<float> pixel(image); !pixel.done(); ++pixel) {
        pixel[0] = float(pixel.x() / 4) / 4;
        pixel[1] = float(pixel.y() / 2) / 4;
        pixel[2] = 0.75f;
        pixel[3] = (pixel.x() / 4 + pixel.y() / 2) % 2 ? 1.0f : 0.25f;
    }
    ASSERT_TRUE(image.write(path, OIIO::TypeDesc::UINT8)) << image.geterror();
}

json material(const char* alpha_mode, int texture)
{
    json result = { { "alphaMode", alpha_mode }, { "doubleSided", true } };
    result["pbrMetallicRoughness"]["baseColorFactor"] = { 0.9, 0.8, 0.7, 0.9 };
    json info = { { "index", texture } };
    info["extensions"]["KHR_texture_transform"]
        = { { "offset", { 0.1, 0.2 } }, { "scale", { 5, 3 } }, { "rotation", 0.4 } };
    result["pbrMetallicRoughness"]["baseColorTexture"] = info;
    return result;
}

} // namespace

TEST_F(MaterialPicture, EqualsThatOfFrames)
{
    const TemporaryFolder folder;
    ASSERT_NO_FATAL_FAILURE(write_texture(folder / "blocks.png"));
    GltfFile file = three_cards();
    file.root["extensionsUsed"] = { "KHR_texture_transform" };
    file.root["images"] = json::array({ json { { "uri", "blocks.png" } } });
    // How each repeats: to the edge, mirrored and again.
    file.root["samplers"] = { { { "wrapS", 33071 }, { "wrapT", 33071 } },
                              { { "wrapS", 33648 }, { "wrapT", 33648 } },
                              { { "wrapS", 10497 }, { "wrapT", 10497 } } };
    for (int sampler = 0; sampler < 3; ++sampler)
        file.root["textures"].push_back({ { "source", 0 }, { "sampler", sampler } });
    file.root["materials"] = { material("BLEND", 2), material("MASK", 1), material("OPAQUE", 0) };
    Request request = request_for("spot.obj", "studio_small_03.hdr");
    request.mesh.mesh = folder.write("cards.gltf", file.text());
    request.light.model = "paper";
    request.camera.elevation = 12;
    for (const char* background : { "none", "environment" }) {
        request.view.background = background;
        const Assets assets = loaded(request);
        const OIIO::ImageBuf picture = drawn(assets, request);
        EXPECT_LT(relative_rmse(picture, traced(assets, request)), 1e-3) << background;
        Request white = request;
        white.view.white = true;
        EXPECT_GT(relative_rmse(drawn(loaded(white), white), picture), 0.1);
    }
}
