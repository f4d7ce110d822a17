// SPDX-License-Identifier: Apache-2.0
#include <vmlight/mesh/opacity_hash.h>

#include <vmlight/base/format.h>
#include <vmlight/mesh/instances.h>
#include <vmlight/mesh/opacity.h>

#include <OpenImageIO/hash.h>

#include <cstdint>
#include <vector>

namespace vmlight {
namespace {

template <class Element> uint64_t fingerprint_of(const std::vector<Element>& elements)
{
    return OIIO::farmhash::Fingerprint64(reinterpret_cast<const char*>(elements.data()),
                                         elements.size() * sizeof(Element));
}

} // namespace

std::string opacity_hash(const Mesh& mesh)
{
    if (mesh.instances) {
        std::string all;
        for (const Mesh& distinct : mesh.instances->meshes)
            all += opacity_hash(distinct);
        Mesh own;
        own.opacity = mesh.opacity;
        own.triangle_materials = mesh.triangle_materials;
        const std::string first = opacity_hash(own);
        return all.empty() ? first : format("{}{:016x}", first, OIIO::farmhash::Fingerprint64(all.data(), all.size()));
    }
    if (!mesh.opacity)
        return "";
    std::vector<uint64_t> parts { fingerprint_of(
        std::vector<uint32_t>(mesh.triangle_materials.begin(), mesh.triangle_materials.end())) };
    std::vector<double> numbers;
    for (const MaterialOpacity& material : mesh.opacity->materials) {
        numbers.insert(numbers.end(), { double(material.mode), material.cutoff, material.factor });
        for (const MaterialOpacity::Texture& texture : material.textures) {
            numbers.push_back(double(texture.uv_set));
            for (int row = 0; row < 3; ++row)
                for (int column = 0; column < 3; ++column)
                    numbers.push_back(texture.uv_transform[row][column]);
            parts.push_back(texture.image ? texture.image->hash() : 0);
        }
    }
    parts.push_back(fingerprint_of(numbers));
    for (const std::vector<Imath::V2f>& uvs : mesh.opacity->uvs)
        parts.push_back(fingerprint_of(uvs));
    return format("{:016x}", fingerprint_of(parts));
}

} // namespace vmlight
