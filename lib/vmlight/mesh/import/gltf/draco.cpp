// SPDX-License-Identifier: Apache-2.0
#include <vmlight/mesh/import/gltf/draco.h>

#include <vmlight/base/format.h>
#include <vmlight/mesh/import/gltf/document.h>
#include <vmlight/mesh/import/gltf/values.h>

#include <algorithm>
#include <memory>
#include <utility>

#include <draco/compression/decode.h>

namespace vmlight::gltf {
namespace {

std::unique_ptr<draco::Mesh> decode(Bytes bytes)
{
    draco::DecoderBuffer buffer;
    buffer.Init(reinterpret_cast<const char*>(bytes.data), bytes.size);
    auto decoded = draco::Decoder().DecodeMeshFromBuffer(&buffer);
    if (!decoded.ok())
        throw Error(format("Draco cannot decode a primitive: {}", decoded.status().error_msg()));
    return std::move(decoded).value();
}

// What a normalized integer is divided by; 1 for what is no integer.
double largest_of(draco::DataType type)
{
    constexpr std::pair<draco::DataType, double> kLargest[] = {
        { draco::DT_INT8, 127 }, { draco::DT_UINT8, 255 }, { draco::DT_INT16, 32767 }, { draco::DT_UINT16, 65535 }
    };
    for (const auto& [integer, largest] : kLargest)
        if (integer == type)
            return largest;
    return 1;
}

// @param is_normalized     by the accessor
Numbers read_attribute(const draco::Mesh& mesh, const draco::PointAttribute& attribute, const std::string& name,
                       bool is_normalized)
{
    constexpr int kMostComponents = 4;
    const bool has_all_points = attribute.is_mapping_identity() || attribute.indices_map_size() >= mesh.num_points();
    if (!has_all_points || attribute.num_components() > kMostComponents)
        throw Error(format("Draco's attribute {} is damaged", name));
    Numbers numbers { mesh.num_points(), attribute.num_components(), {} };
    // Draco divides those that its own header calls normalized, which writers of glTF leave to the accessor.
    const double divisor = is_normalized && !attribute.normalized() ? largest_of(attribute.data_type()) : 1;
    numbers.values.resize(numbers.count * numbers.components);
    for (uint32_t point = 0; point < mesh.num_points(); ++point) {
        const draco::AttributeValueIndex value = attribute.mapped_index(draco::PointIndex(point));
        double* dst = &numbers.values[point * numbers.components];
        if (value.value() >= attribute.size() || !attribute.ConvertValue(value, int8_t(numbers.components), dst))
            throw Error(format("Draco has no {} of vertex {}", name, point));
        if (divisor > 1)
            std::for_each_n(dst, numbers.components,
                            [&](double& number) { number = std::max(number / divisor, -1.0); });
    }
    return numbers;
}

} // namespace

DracoPrimitive decompress_draco(Document& document, const tinygltf::Primitive& primitive,
                                const std::vector<std::string>& wanted)
{
    const tinygltf::Value& extension = primitive.extensions.at("KHR_draco_mesh_compression");
    if (!extension.IsObject() || !extension.Has("attributes"))
        throw Error("KHR_draco_mesh_compression has no attributes");
    const tinygltf::Value& ids = extension.Get("attributes");
    const std::unique_ptr<draco::Mesh> mesh = decode(document.view(index_of(extension, "bufferView")));
    DracoPrimitive result;
    for (const std::string& name : wanted) {
        const int id = index_of(ids, name.c_str());
        if (id < 0)
            continue;
        const draco::PointAttribute* attribute = mesh->GetAttributeByUniqueId(uint32_t(id));
        if (!attribute)
            throw Error(format("{} is Draco's attribute {}, which does not exist", name, id));
        const auto accessor = primitive.attributes.find(name);
        result.attributes[name] = read_attribute(*mesh, *attribute, name,
                                                 accessor != primitive.attributes.end()
                                                     && has_normalized_integers(document, accessor->second));
    }
    for (uint32_t face = 0; face < mesh->num_faces(); ++face)
        for (const draco::PointIndex& corner : mesh->face(draco::FaceIndex(face)))
            result.indices.push_back(corner.value());
    return result;
}

} // namespace vmlight::gltf
