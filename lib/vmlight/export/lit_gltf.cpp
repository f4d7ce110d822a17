// SPDX-License-Identifier: Apache-2.0
#include <vmlight/export/lit_gltf.h>

#include <vmlight/export/lightmap_encoding.h>
#include <vmlight/image/texture_file.h>
#include <vmlight/mesh/export/gltf_model.h>

#include <OpenImageIO/color.h>

#include <algorithm>

namespace vmlight {
namespace {

constexpr const char *kUnlit = "KHR_materials_unlit", *kStrength = "KHR_materials_emissive_strength",
                     *kSpecular = "KHR_materials_specular";

int add_texture(tinygltf::Model& model, const std::string& png, const std::string& name)
{
    tinygltf::Image image;
    image.name = name;
    image.mimeType = "image/png";
    image.bufferView = add_buffer_view(model, png.data(), png.size());
    model.images.push_back(image);
    tinygltf::Texture texture;
    texture.source = int(model.images.size()) - 1;
    texture.sampler = 0;
    model.textures.push_back(texture);
    return int(model.textures.size()) - 1;
}

void add_sampler(tinygltf::Model& model)
{
    tinygltf::Sampler sampler;
    sampler.minFilter = TINYGLTF_TEXTURE_FILTER_LINEAR_MIPMAP_LINEAR;
    sampler.magFilter = TINYGLTF_TEXTURE_FILTER_LINEAR;
    sampler.wrapS = sampler.wrapT = TINYGLTF_TEXTURE_WRAP_CLAMP_TO_EDGE;
    model.samplers.push_back(sampler);
}

void use_extension(tinygltf::Model& model, tinygltf::Material& material, const char* name,
                   const tinygltf::Value::Object& value)
{
    material.extensions[name] = tinygltf::Value(value);
    std::vector<std::string>& used = model.extensionsUsed;
    if (std::find(used.begin(), used.end(), name) == used.end())
        used.push_back(name);
}

struct GltfTextures
{
    int occlusion = -1, light = -1;
    double strength = 1;
    bool is_unlit = false;
};

bool add_textures(GltfTextures& dst, tinygltf::Model& model, const OIIO::ImageBuf& occlusion,
                  const OIIO::ImageBuf* light, int64_t& cut_off, std::string& error)
{
    std::string png;
    add_sampler(model);
    if (!encode_png(png, occlusion, TextureDepth::Eight, error))
        return false;
    dst.occlusion = add_texture(model, png, "occlusion");
    if (!light)
        return true;
    OIIO::ImageBuf encoded = light->copy(OIIO::TypeFloat);
    auto* values = static_cast<float*>(encoded.localpixels());
    if (!dst.is_unlit)
        dst.strength = std::max(1.0, double(greatest_value(encoded)));
    for (size_t i = 0; i < encoded.spec().image_pixels(); ++i, values += 3) {
        if (std::max({ values[0], values[1], values[2] }) > float(dst.strength))
            ++cut_off;
        for (int c = 0; c < 3; ++c)
            values[c] = OIIO::linear_to_sRGB(std::min(1.0f, float(double(values[c]) / dst.strength)));
    }
    if (!encode_png(png, encoded, TextureDepth::Eight, error))
        return false;
    dst.light = add_texture(model, png, "light");
    return true;
}

void light_material(tinygltf::Model& model, tinygltf::Material& material, const GltfTextures& textures)
{
    material.occlusionTexture.index = textures.occlusion;
    if (textures.light < 0)
        return;
    tinygltf::PbrMetallicRoughness& pbr = material.pbrMetallicRoughness;
    const double alpha = pbr.baseColorFactor.size() == 4 ? pbr.baseColorFactor[3] : 1;
    const double color = textures.is_unlit ? 1 : 0;
    pbr.baseColorFactor = { color, color, color, alpha };
    if (textures.is_unlit) {
        pbr.baseColorTexture.index = textures.light;
        pbr.baseColorTexture.texCoord = 1;
        use_extension(model, material, kUnlit, {});
        return;
    }
    material.emissiveFactor = { 1, 1, 1 };
    material.emissiveTexture.index = textures.light;
    material.emissiveTexture.texCoord = 1;
    use_extension(model, material, kSpecular, { { "specularFactor", tinygltf::Value(0.0) } });
    if (textures.strength > 1)
        use_extension(model, material, kStrength, { { "emissiveStrength", tinygltf::Value(textures.strength) } });
}

// Parts without UVs keep the material as it was.
void light_parts(tinygltf::Model& model, const GltfTextures& textures)
{
    const std::vector<tinygltf::Material> plain = model.materials;
    std::vector<bool> is_lit(plain.size());
    std::vector<tinygltf::Primitive>& parts = model.meshes[0].primitives;
    int of_none = -1;
    for (tinygltf::Primitive& part : parts) {
        const auto uvs = part.attributes.find("TEXCOORD_0");
        if (uvs == part.attributes.end())
            continue;
        if (textures.light >= 0)
            part.attributes["TEXCOORD_1"] = uvs->second;
        if (part.material < 0 && of_none < 0) {
            of_none = int(model.materials.size());
            model.materials.emplace_back().pbrMetallicRoughness.metallicFactor = 0;
            light_material(model, model.materials.back(), textures);
        }
        if (part.material < 0) {
            part.material = of_none;
        } else if (!is_lit[size_t(part.material)]) {
            is_lit[size_t(part.material)] = true;
            light_material(model, model.materials[size_t(part.material)], textures);
        }
    }
    for (tinygltf::Primitive& part : parts)
        if (!part.attributes.count("TEXCOORD_0") && part.material >= 0 && is_lit[size_t(part.material)]) {
            model.materials.push_back(plain[size_t(part.material)]);
            part.material = int(model.materials.size()) - 1;
        }
}

} // namespace

bool make_lit_gltf(std::string& bytes, const Mesh& mesh, const OIIO::ImageBuf& occlusion, const OIIO::ImageBuf* light,
                   const GltfLightParams& params, int64_t& cut_off, std::string& error)
{
    cut_off = 0;
    if (mesh.uvs.empty()) {
        error = "the mesh has no UVs";
        return false;
    }
    tinygltf::Model model = gltf_model(mesh);
    GltfTextures textures;
    textures.is_unlit = params.gltf_light == "unlit";
    if (!add_textures(textures, model, occlusion, light, cut_off, error))
        return false;
    light_parts(model, textures);
    bytes = glb_bytes(model);
    return true;
}

} // namespace vmlight
