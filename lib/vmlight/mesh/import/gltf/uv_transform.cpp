// SPDX-License-Identifier: Apache-2.0
#include <vmlight/mesh/import/gltf/uv_transform.h>

#include <vmlight/base/format.h>
#include <vmlight/mesh/import/gltf/accessor.h>
#include <vmlight/mesh/import/gltf/document.h>
#include <vmlight/mesh/import/gltf/values.h>

#include <OpenImageIO/strutil.h>

#include <algorithm>
#include <cmath>
#include <string>

namespace vmlight::gltf {
namespace {

using Imath::M33d;
using Imath::V2d;

V2d pair_of(const tinygltf::Value& object, const char* name, const V2d& otherwise)
{
    if (!object.Has(name) || !object.Get(name).IsArray() || object.Get(name).ArrayLen() != 2)
        return otherwise;
    const tinygltf::Value& pair = object.Get(name);
    return V2d(pair.Get(0).IsNumber() ? pair.Get(0).GetNumberAsDouble() : otherwise.x,
               pair.Get(1).IsNumber() ? pair.Get(1).GetNumberAsDouble() : otherwise.y);
}

// The transforms of a material's textures that are looked up with a UV set.
std::vector<M33d> transforms_of(const tinygltf::Material& material, int uv_set)
{
    std::vector<M33d> transforms;
    const auto add = [&](const auto& texture) {
        if (texture.index < 0)
            return;
        int set = texture.texCoord;
        const M33d transform = texture_transform(texture.extensions, set);
        if (set == uv_set)
            transforms.push_back(transform);
    };
    add(material.pbrMetallicRoughness.baseColorTexture);
    add(material.pbrMetallicRoughness.metallicRoughnessTexture);
    add(material.normalTexture);
    add(material.occlusionTexture);
    add(material.emissiveTexture);
    return transforms;
}

} // namespace

M33d texture_transform(const tinygltf::ExtensionMap& extensions, int& uv_set)
{
    const auto extension = extensions.find("KHR_texture_transform");
    if (extension == extensions.end() || !extension->second.IsObject())
        return M33d();
    const tinygltf::Value& values = extension->second;
    uv_set = values.Has("texCoord") ? index_of(values, "texCoord") : uv_set;
    const V2d offset = pair_of(values, "offset", V2d(0)), scale = pair_of(values, "scale", V2d(1));
    const double angle = number_of(values, "rotation", 0);
    // offset * rotation * scale for columns, with the rotation that the specification's GLSL writes by columns.
    const double c = std::cos(angle), s = std::sin(angle);
    return M33d(c * scale.x, -s * scale.x, 0, s * scale.y, c * scale.y, 0, offset.x, offset.y, 1);
}

void restore_quantized_uvs(std::vector<V2d>& uvs, Document& document, const tinygltf::Primitive& primitive, int uv_set)
{
    const tinygltf::Model& model = document.model();
    const auto accessor = primitive.attributes.find(format("TEXCOORD_{}", uv_set));
    const bool is_integer = accessor != primitive.attributes.end() && has_integers(document, accessor->second);
    const bool is_normalized = is_integer && has_normalized_integers(document, accessor->second);
    std::vector<M33d> transforms;
    if (primitive.material >= 0 && size_t(primitive.material) < model.materials.size())
        transforms = transforms_of(model.materials[size_t(primitive.material)], uv_set);
    const bool has_transform
        = std::any_of(transforms.begin(), transforms.end(), [](const M33d& m) { return m != M33d(); });
    const bool is_packed = OIIO::Strutil::istarts_with(model.asset.generator, "gltfpack");
    if (is_integer && !is_normalized && !has_transform) {
        const bool is_layout
            = std::all_of(uvs.begin(), uvs.end(), [](const V2d& uv) { return std::max(uv.x, uv.y) <= 1; });
        if (is_layout)
            return;
        document.builder().warn(format("UV set {} is of integers that nothing scales back to [0, 1], and is not read: "
                                       "write it as floats (gltfpack: -vtf)",
                                       uv_set));
        uvs.clear();
    } else if (is_integer && has_transform && (!is_normalized || is_packed)) {
        if (std::any_of(transforms.begin(), transforms.end(), [&](const M33d& m) { return m != transforms[0]; }))
            document.builder().warn(
                format("textures of one material transform UV set {} differently: the map is in the "
                       "UVs of the first",
                       uv_set));
        for (V2d& uv : uvs)
            uv = uv * transforms[0];
    } else if (has_transform) {
        document.builder().warn(format("textures move over UV set {} (KHR_texture_transform): the map is in the UVs of "
                                       "the mesh, without that",
                                       uv_set));
    }
}

} // namespace vmlight::gltf
