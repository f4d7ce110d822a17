// SPDX-License-Identifier: Apache-2.0
#include "gltf_file.h"

using namespace mesh_files;

namespace {

json texture_json(int index, const json& transform = {})
{
    json info = { { "index", index } };
    if (!transform.is_null())
        info["extensions"]["KHR_texture_transform"] = transform;
    return info;
}

} // namespace

TEST_F(MeshFiles, MaterialsOfAGltf)
{
    GltfFile file = triangle_file();
    folder.write("leaf color.png", "not looked at");
    file.root["images"] = { { { "uri", "leaf%20color.png" } }, { { "uri", "data:image/png;base64,QUJD" } } };
    file.root["samplers"] = { { { "wrapS", 33071 }, { "wrapT", 33648 }, { "magFilter", 9728 } } };
    file.root["textures"] = { { { "source", 0 }, { "sampler", 0 } }, { { "source", 1 } } };
    json material = { { "name", "leaf" },
                      { "alphaMode", "MASK" },
                      { "alphaCutoff", 0.25 },
                      { "doubleSided", true },
                      { "normalTexture", texture_json(1) },
                      { "occlusionTexture", texture_json(1) } };
    material["pbrMetallicRoughness"]
        = { { "baseColorFactor", { 0.5, 0.25, 1, 0.75 } },
            { "baseColorTexture",
              texture_json(0, { { "offset", { 0.25, 0 } }, { "scale", { 0.5, 0.5 } }, { "texCoord", 1 } }) } };
    material["normalTexture"]["scale"] = 2;
    material["occlusionTexture"]["strength"] = 0.5;
    file.root["materials"] = { material, { { "alphaMode", "BLEND" } } };
    file.primitive()["material"] = 0;
    const Mesh mesh = read("a.gltf", file.text());
    const Material& leaf = mesh.materials[0];
    EXPECT_EQ(leaf.name, "leaf");
    EXPECT_EQ(leaf.alpha_mode, AlphaMode::mask);
    EXPECT_EQ(leaf.alpha_cutoff, 0.25f);
    EXPECT_TRUE(leaf.is_double_sided);
    EXPECT_EQ(leaf.base_color, Imath::Color4f(0.5f, 0.25f, 1, 0.75f));
    EXPECT_EQ(leaf.base_color_texture.path, folder / "leaf color.png");
    EXPECT_EQ(leaf.base_color_texture.wrap_s, "clamp");
    EXPECT_EQ(leaf.base_color_texture.wrap_t, "mirror");
    EXPECT_TRUE(leaf.base_color_texture.is_nearest);
    EXPECT_EQ(leaf.base_color_texture.uv_set, 1);
    // v down: (u, v) -> (u / 2 + 1/4, v / 2); of v up, (u, w) -> (u / 2 + 1/4, w / 2 + 1/2).
    const Imath::V2d at = Imath::V2d(1, 1) * leaf.base_color_texture.uv_transform;
    EXPECT_DOUBLE_EQ(at.x, 0.75);
    EXPECT_DOUBLE_EQ(at.y, 1);
    EXPECT_DOUBLE_EQ((Imath::V2d(0, 0) * leaf.base_color_texture.uv_transform).y, 0.5);
    ASSERT_TRUE(leaf.normal_texture.embedded);
    EXPECT_EQ(*leaf.normal_texture.embedded, "ABC");
    EXPECT_EQ(leaf.normal_texture.wrap_s, "periodic");
    EXPECT_EQ(leaf.normal_scale, 2);
    EXPECT_EQ(leaf.occlusion_strength, 0.5f);
    EXPECT_EQ(mesh.materials[1].alpha_mode, AlphaMode::blend);
    EXPECT_FALSE(mesh.materials[1].base_color_texture.exists());
    EXPECT_TRUE(mesh.warnings.empty());
}

TEST_F(MeshFiles, TexturesThatAreMissingAreWarnedOf)
{
    GltfFile file = triangle_file();
    file.root["images"] = { { { "uri", "none.png" } } };
    file.root["textures"] = { { { "source", 0 } }, { { "source", 5 } } };
    file.root["materials"] = { { { "normalTexture", texture_json(0) }, { "occlusionTexture", texture_json(1) } },
                               { { "normalTexture", texture_json(2) } } };
    const Mesh mesh = read("a.gltf", file.text());
    EXPECT_EQ(mesh.warnings,
              (std::vector<std::string> { "image 0: \"" + folder / "none.png" + "\" does not exist",
                                          "there is no image 5", "a material uses texture 2, but there are only 2" }));
    EXPECT_FALSE(mesh.materials[0].normal_texture.exists());
}

TEST_F(MeshFiles, SpecularGlossinessHasItsDiffuseColor)
{
    GltfFile file = triangle_file();
    file.root["images"] = { { { "uri", "data:image/png;base64,QUJD" } } };
    file.root["textures"] = { { { "source", 0 } } };
    json& extension = file.root["materials"][0]["extensions"]["KHR_materials_pbrSpecularGlossiness"];
    extension = { { "diffuseFactor", { 0.5, 0.5, 0.5, 1 } }, { "diffuseTexture", { { "index", 0 } } } };
    const Mesh mesh = read("a.gltf", file.text());
    EXPECT_EQ(mesh.materials[0].base_color, Imath::Color4f(0.5f, 0.5f, 0.5f, 1));
    EXPECT_TRUE(mesh.materials[0].base_color_texture.exists());
}

TEST_F(MeshFiles, ImagesOfAGlbAreRangesOfTheFile)
{
    GltfFile file = triangle_file();
    const size_t view = file.add_view("an image file");
    file.root["images"] = { { { "bufferView", view }, { "mimeType", "image/png" } } };
    file.root["textures"] = { { { "source", 0 } } };
    file.root["materials"] = { { { "normalTexture", texture_json(0) } } };
    const std::string path = folder.write("a.glb", file.glb());
    const MaterialTexture image = read(path).materials[0].normal_texture;
    EXPECT_EQ(image.path, path);
    EXPECT_EQ(file.glb().substr(image.offset, image.length), "an image file");
}
