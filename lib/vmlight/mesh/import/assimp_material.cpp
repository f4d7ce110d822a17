// SPDX-License-Identifier: Apache-2.0
#include <vmlight/mesh/import/assimp_importer.h>
#include <vmlight/mesh/import/side_files.h>

#include <assimp/material.h>
#include <assimp/scene.h>

#include <cmath>

namespace vmlight {
namespace {

const char* wrap_of(const aiMaterial& material, const char* key, aiTextureType type)
{
    int mode = aiTextureMapMode_Wrap;
    material.Get(key, type, 0, mode);
    return mode == aiTextureMapMode_Mirror ? "mirror" : mode == aiTextureMapMode_Wrap ? "periodic" : "clamp";
}

// Assimp scales, turns about the middle of the texture, and moves.
Imath::M33d uv_transform_of(const aiMaterial& material, aiTextureType type)
{
    aiUVTransform transform;
    material.Get(AI_MATKEY_UVTRANSFORM(type, 0), transform);
    const double c = std::cos(double(transform.mRotation)), s = std::sin(double(transform.mRotation));
    const Imath::M33d scale(transform.mScaling.x, 0, 0, 0, transform.mScaling.y, 0, 0, 0, 1);
    const Imath::M33d to_middle(1, 0, 0, 0, 1, 0, -0.5, -0.5, 1), turn(c, s, 0, -s, c, 0, 0, 0, 1);
    const Imath::M33d from_middle(1, 0, 0, 0, 1, 0, 0.5 + transform.mTranslation.x, 0.5 + transform.mTranslation.y, 1);
    return scale * to_middle * turn * from_middle;
}

// The first texture of a type, if there is one.
MaterialTexture texture_of(const aiScene& imported, const aiMaterial& material, aiTextureType type,
                           const std::string& folder)
{
    MaterialTexture texture;
    aiString path;
    if (material.Get(AI_MATKEY_TEXTURE(type, 0), path) != aiReturn_SUCCESS || path.length == 0)
        return texture;
    const aiTexture* embedded = imported.GetEmbeddedTexture(path.C_Str());
    if (embedded && embedded->mHeight != 0) // bare texels
        return texture;
    if (embedded)
        texture.embedded
            = std::make_shared<const std::string>(reinterpret_cast<const char*>(embedded->pcData), embedded->mWidth);
    else
        texture.path = side_path(folder, path.C_Str());
    material.Get(AI_MATKEY_UVWSRC(type, 0), texture.uv_set);
    texture.wrap_s = wrap_of(material, _AI_MATKEY_MAPPINGMODE_U_BASE, type);
    texture.wrap_t = wrap_of(material, _AI_MATKEY_MAPPINGMODE_V_BASE, type);
    texture.uv_transform = uv_transform_of(material, type);
    return texture;
}

Material material_of(const aiScene& imported, const aiMaterial& source, const std::string& folder)
{
    Material material;
    const auto texture = [&](aiTextureType type) { return texture_of(imported, source, type, folder); };
    material.name = source.GetName().C_Str();
    aiColor4D color(1, 1, 1, 1);
    if (source.Get(AI_MATKEY_BASE_COLOR, color) != aiReturn_SUCCESS)
        source.Get(AI_MATKEY_COLOR_DIFFUSE, color);
    float opacity = 1;
    source.Get(AI_MATKEY_OPACITY, opacity);
    material.base_color = { color.r, color.g, color.b, opacity };
    material.base_color_texture = texture(aiTextureType_BASE_COLOR);
    if (!material.base_color_texture.exists())
        material.base_color_texture = texture(aiTextureType_DIFFUSE);
    material.opacity_texture = texture(aiTextureType_OPACITY);
    material.normal_texture = texture(aiTextureType_NORMALS);
    for (const aiTextureType heights : { aiTextureType_HEIGHT, aiTextureType_DISPLACEMENT })
        material.has_heights |= texture(heights).exists();
    if (opacity < 1 || material.opacity_texture.exists())
        material.alpha_mode = AlphaMode::blend;
    if (material.opacity_texture.path == material.base_color_texture.path && !material.opacity_texture.embedded)
        material.opacity_texture = {}; // the alpha of that image
    int is_double_sided = 0;
    source.Get(AI_MATKEY_TWOSIDED, is_double_sided);
    material.is_double_sided = is_double_sided != 0;
    return material;
}

} // namespace

std::vector<Material> materials_of(const aiScene& imported, const std::string& folder)
{
    std::vector<Material> materials;
    for (unsigned i = 0; i < imported.mNumMaterials; ++i)
        materials.push_back(material_of(imported, *imported.mMaterials[i], folder));
    return materials;
}

} // namespace vmlight
