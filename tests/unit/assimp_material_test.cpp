// SPDX-License-Identifier: Apache-2.0
// What assimp tells of materials.
#include "mesh_fixture.h"

#include <vmlight/mesh/import/assimp_importer.h>

#include <assimp/material.h>
#include <assimp/scene.h>
#include <assimp/texture.h>

#include <memory>

using namespace mesh_files;
using Imath::C4f;
using Imath::V2d;

namespace {

const aiTextureType kColor = aiTextureType_DIFFUSE;

// The material that `fill` describes, of a file in "folder".
template <class Fill> Material material_of(const Fill& fill)
{
    auto source = std::make_unique<aiMaterial>();
    aiScene scene;
    fill(*source, scene);
    scene.mNumMaterials = 1;
    scene.mMaterials = new aiMaterial* [1] { source.release() };
    const std::vector<Material> materials = materials_of(scene, "folder");
    EXPECT_EQ(materials.size(), 1u);
    return materials[0];
}

template <class Value>
void set(aiMaterial& material, const Value& value, const char* key, unsigned type, unsigned index)
{
    material.AddProperty(&value, 1, key, type, index);
}

void set_text(aiMaterial& material, const char* text, const char* key, unsigned type, unsigned index)
{
    const aiString value(text);
    material.AddProperty(&value, key, type, index);
}

} // namespace

TEST(AssimpMaterials, HaveColourOpacityAndSides)
{
    const Material plain = material_of([](aiMaterial&, aiScene&) {});
    EXPECT_EQ(plain.base_color, C4f(1, 1, 1, 1));
    EXPECT_EQ(plain.alpha_mode, AlphaMode::opaque);
    EXPECT_FALSE(plain.is_double_sided);
    const Material glass = material_of([](aiMaterial& m, aiScene&) {
        set_text(m, "a b", AI_MATKEY_NAME);
        set(m, aiColor4D(0.1f, 0.2f, 0.3f, 1), AI_MATKEY_COLOR_DIFFUSE);
        set(m, 0.25f, AI_MATKEY_OPACITY);
        set(m, 1, AI_MATKEY_TWOSIDED);
    });
    EXPECT_EQ(glass.name, "a b");
    EXPECT_EQ(glass.base_color, C4f(0.1f, 0.2f, 0.3f, 0.25f));
    EXPECT_EQ(glass.alpha_mode, AlphaMode::blend);
    EXPECT_TRUE(glass.is_double_sided);
    EXPECT_EQ(material_of([](aiMaterial& m, aiScene&) {
                  set(m, aiColor4D(0, 0, 0, 1), AI_MATKEY_COLOR_DIFFUSE);
                  set(m, aiColor4D(0.5f, 0.5f, 0.5f, 1), AI_MATKEY_BASE_COLOR);
              }).base_color.r,
              0.5f);
}

TEST(AssimpMaterials, HaveTextures)
{
    const Material material = material_of([](aiMaterial& m, aiScene&) {
        set_text(m, "maps\\a b.png", AI_MATKEY_TEXTURE(kColor, 0));
        set(m, int(aiTextureMapMode_Mirror), AI_MATKEY_MAPPINGMODE_U(kColor, 0));
        set(m, int(aiTextureMapMode_Clamp), AI_MATKEY_MAPPINGMODE_V(kColor, 0));
        set(m, 1, AI_MATKEY_UVWSRC(kColor, 0));
        set_text(m, "n.png", AI_MATKEY_TEXTURE(aiTextureType_NORMALS, 0));
        set_text(m, "h.png", AI_MATKEY_TEXTURE(aiTextureType_HEIGHT, 0));
        set_text(m, "o.png", AI_MATKEY_TEXTURE(aiTextureType_OPACITY, 0));
    });
    EXPECT_EQ(material.base_color_texture.path, "folder/maps/a b.png");
    EXPECT_EQ(material.base_color_texture.wrap_s, "mirror");
    EXPECT_EQ(material.base_color_texture.wrap_t, "clamp");
    EXPECT_EQ(material.base_color_texture.uv_set, 1);
    EXPECT_EQ(material.normal_texture.path, "folder/n.png");
    EXPECT_EQ(material.opacity_texture.path, "folder/o.png");
    EXPECT_EQ(material.alpha_mode, AlphaMode::blend);
    const Material heights = material_of(
        [](aiMaterial& m, aiScene&) { set_text(m, "h.png", AI_MATKEY_TEXTURE(aiTextureType_HEIGHT, 0)); });
    EXPECT_FALSE(heights.normal_texture.exists());
    EXPECT_FALSE(heights.base_color_texture.exists());
}

TEST(AssimpMaterials, MoveTextures)
{
    const auto looked_up = [](float u, float v, float rotation) {
        const Material material = material_of([&](aiMaterial& m, aiScene&) {
            aiUVTransform transform;
            transform.mScaling = aiVector2D(2, 1);
            transform.mRotation = rotation;
            transform.mTranslation = aiVector2D(0.25f, 0);
            set_text(m, "a.png", AI_MATKEY_TEXTURE(kColor, 0));
            m.AddProperty(&transform, 1, AI_MATKEY_UVTRANSFORM(kColor, 0));
        });
        return V2d(u, v) * material.base_color_texture.uv_transform;
    };
    EXPECT_LT((looked_up(0.5f, 0.5f, 0) - V2d(1.25, 0.5)).length(), 1e-6);
    EXPECT_LT((looked_up(0.5f, 0.5f, float(M_PI / 2)) - V2d(0.75, 1)).length(), 1e-6) << "about the middle";
}

TEST(AssimpMaterials, HaveEmbeddedImages)
{
    const Material material = material_of([](aiMaterial& m, aiScene& scene) {
        set_text(m, "*0", AI_MATKEY_TEXTURE(kColor, 0));
        auto* image = new aiTexture;
        image->mWidth = 8;
        image->pcData = new aiTexel[2];
        std::memcpy(image->pcData, "PNG data", 8);
        scene.mNumTextures = 1;
        scene.mTextures = new aiTexture* [1] { image };
    });
    ASSERT_TRUE(material.base_color_texture.embedded);
    EXPECT_EQ(*material.base_color_texture.embedded, "PNG data");
    EXPECT_EQ(material.base_color_texture.path, "");
}

TEST(AssimpMaterials, HeightsAreKnownToBeThere)
{
    for (const aiTextureType type : { aiTextureType_HEIGHT, aiTextureType_DISPLACEMENT, aiTextureType_NORMALS }) {
        const Material material
            = material_of([&](aiMaterial& m, aiScene&) { set_text(m, "h.png", AI_MATKEY_TEXTURE(type, 0)); });
        EXPECT_EQ(material.has_heights, type != aiTextureType_NORMALS);
        EXPECT_EQ(material.normal_texture.exists(), type == aiTextureType_NORMALS);
    }
}
