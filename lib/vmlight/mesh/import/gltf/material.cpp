// SPDX-License-Identifier: Apache-2.0
#include <vmlight/mesh/import/gltf/material.h>

#include <vmlight/base/format.h>
#include <vmlight/mesh/import/gltf/document.h>
#include <vmlight/mesh/import/gltf/uv_transform.h>
#include <vmlight/mesh/import/gltf/values.h>

#include <utility>

namespace vmlight::gltf {
namespace {

using Imath::M33d;

const char* wrap_of(int mode)
{
    return mode == TINYGLTF_TEXTURE_WRAP_CLAMP_TO_EDGE  ? "clamp"
        : mode == TINYGLTF_TEXTURE_WRAP_MIRRORED_REPEAT ? "mirror"
                                                        : "periodic";
}

// The image of a texture: of an extension that the image libraries read, else its own.
int image_of(const tinygltf::Texture& texture)
{
    for (const char* name : { "EXT_texture_webp", "EXT_texture_avif" })
        if (const auto extension = texture.extensions.find(name);
            texture.source < 0 && extension != texture.extensions.end())
            return index_of(extension->second, "source");
    return texture.source;
}

MaterialTexture read_texture(Document& document, int index, int uv_set, const tinygltf::ExtensionMap& extensions)
{
    const tinygltf::Model& model = document.model();
    MaterialTexture result;
    if (index < 0)
        return result;
    if (size_t(index) >= model.textures.size()) {
        result.missing = format("a material uses texture {}, but there are only {}", index, model.textures.size());
        document.builder().warn(result.missing);
        return result;
    }
    const tinygltf::Texture& texture = model.textures[size_t(index)];
    document.find_image(result, image_of(texture));
    if (texture.sampler >= 0 && size_t(texture.sampler) < model.samplers.size()) {
        const tinygltf::Sampler& sampler = model.samplers[size_t(texture.sampler)];
        result.wrap_s = wrap_of(sampler.wrapS);
        result.wrap_t = wrap_of(sampler.wrapT);
        result.is_nearest = sampler.magFilter == TINYGLTF_TEXTURE_FILTER_NEAREST;
    }
    result.uv_set = uv_set;
    const M33d transform = texture_transform(extensions, result.uv_set);
    const M33d flip(1, 0, 0, 0, -1, 0, 0, 1, 1); // v up to v down and back
    result.uv_transform = flip * transform * flip;
    return result;
}

template <class Texture> MaterialTexture read_texture(Document& document, const Texture& texture)
{
    return read_texture(document, texture.index, texture.texCoord, texture.extensions);
}

void set_base_color(Material& dst, const std::vector<double>& factor)
{
    if (factor.size() == 4)
        dst.base_color = Imath::Color4f(float(factor[0]), float(factor[1]), float(factor[2]), float(factor[3]));
}

void read_specular_glossiness(Document& document, Material& dst, const tinygltf::Value& values)
{
    if (values.Has("diffuseFactor") && values.Get("diffuseFactor").IsArray()) {
        std::vector<double> factor;
        for (size_t i = 0; i < values.Get("diffuseFactor").ArrayLen(); ++i)
            factor.push_back(values.Get("diffuseFactor").Get(int(i)).GetNumberAsDouble());
        set_base_color(dst, factor);
    }
    if (values.Has("diffuseTexture")) {
        const tinygltf::Value& texture = values.Get("diffuseTexture");
        tinygltf::ExtensionMap extensions;
        if (texture.IsObject() && texture.Has("extensions") && texture.Get("extensions").Has("KHR_texture_transform"))
            extensions["KHR_texture_transform"] = texture.Get("extensions").Get("KHR_texture_transform");
        dst.base_color_texture
            = read_texture(document, index_of(texture, "index"), index_of(texture, "texCoord", 0), extensions);
    }
}

Material read_material(Document& document, const tinygltf::Material& material)
{
    Material result;
    result.name = material.name;
    set_base_color(result, material.pbrMetallicRoughness.baseColorFactor);
    result.base_color_texture = read_texture(document, material.pbrMetallicRoughness.baseColorTexture);
    const auto glossiness = material.extensions.find("KHR_materials_pbrSpecularGlossiness");
    if (glossiness != material.extensions.end() && glossiness->second.IsObject())
        read_specular_glossiness(document, result, glossiness->second);
    result.alpha_mode = material.alphaMode == "MASK" ? AlphaMode::mask
        : material.alphaMode == "BLEND"              ? AlphaMode::blend
                                                     : AlphaMode::opaque;
    result.alpha_cutoff = float(material.alphaCutoff);
    result.normal_texture = read_texture(document, material.normalTexture);
    result.normal_scale = float(material.normalTexture.scale);
    result.occlusion_texture = read_texture(document, material.occlusionTexture);
    result.occlusion_strength = float(material.occlusionTexture.strength);
    result.is_double_sided = material.doubleSided;
    return result;
}

} // namespace

void add_materials(Document& document)
{
    for (const tinygltf::Material& material : document.model().materials)
        document.builder().add_material(read_material(document, material));
    document.builder().add_material(Material());
}

} // namespace vmlight::gltf
