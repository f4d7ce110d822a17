// SPDX-License-Identifier: Apache-2.0
#include <vmlight/mesh/import/gltf/primitive.h>

#include <vmlight/base/format.h>
#include <vmlight/base/text_format.h>
#include <vmlight/mesh/import/gltf/accessor.h>
#include <vmlight/mesh/import/gltf/document.h>
#include <vmlight/mesh/import/gltf/draco.h>
#include <vmlight/mesh/import/gltf/uv_transform.h>

#include <algorithm>
#include <numeric>
#include <string>

namespace vmlight::gltf {
namespace {

using Imath::V2d;
using Imath::V2f;
using Imath::V3d;

// The attributes of a primitive, from Draco where they are compressed, else from accessors.
class Attributes
{
public:
    Attributes(Document& document, const tinygltf::Primitive& primitive, const std::vector<std::string>& wanted)
        : m_document(document)
        , m_primitive(primitive)
    {
        m_is_compressed = primitive.extensions.count("KHR_draco_mesh_compression") > 0;
        if (m_is_compressed)
            m_draco = decompress_draco(document, primitive, wanted);
    }

    bool has(const std::string& name) const
    {
        return m_draco.attributes.count(name) > 0 || m_primitive.attributes.count(name) > 0;
    }

    /// @param count    as of read_accessor()
    Numbers read(const std::string& name, int type, size_t count)
    {
        const auto decoded = m_draco.attributes.find(name);
        if (decoded == m_draco.attributes.end())
            return read_accessor(m_document, m_primitive.attributes.at(name), type, count, name);
        const size_t components = size_t(tinygltf::GetNumComponentsInType(uint32_t(type)));
        if (decoded->second.components != components)
            throw Error(format("{} has elements of {}, not {}", name,
                               count_text(int64_t(decoded->second.components), "number", "numbers"), components));
        return std::move(decoded->second);
    }

    std::vector<uint32_t> read_indices(size_t vertices)
    {
        if (m_is_compressed)
            return std::move(m_draco.indices);
        if (m_primitive.indices >= 0)
            return gltf::read_indices(m_document, m_primitive.indices);
        std::vector<uint32_t> all(vertices);
        std::iota(all.begin(), all.end(), 0u);
        return all;
    }

    /// Draco holds triangles, whatever the primitive's mode.
    int mode() const { return m_is_compressed || m_primitive.mode < 0 ? TINYGLTF_MODE_TRIANGLES : m_primitive.mode; }

private:
    Document& m_document;
    const tinygltf::Primitive& m_primitive;
    DracoPrimitive m_draco;
    bool m_is_compressed = false;
};

std::vector<V3d> to_vectors(const Numbers& numbers)
{
    std::vector<V3d> vectors(numbers.count);
    for (size_t i = 0; i < numbers.count; ++i)
        vectors[i] = V3d(numbers[i][0], numbers[i][1], numbers[i][2]);
    return vectors;
}

// Add the displacements of the morph targets to vectors of three or two numbers.
template <class Vector>
void add_morph_targets(std::vector<Vector>& vectors, Document& document, const tinygltf::Primitive& primitive,
                       const std::string& name, int type, const std::vector<double>& weights)
{
    for (size_t target = 0; target < std::min(weights.size(), primitive.targets.size()); ++target) {
        const auto attribute = primitive.targets[target].find(name);
        if (weights[target] == 0 || attribute == primitive.targets[target].end())
            continue;
        const Numbers offsets = read_accessor(document, attribute->second, type, vectors.size(),
                                              format("{} of morph target {}", name, target));
        for (size_t i = 0; i < vectors.size(); ++i)
            for (unsigned k = 0; k < Vector::dimensions(); ++k)
                vectors[i][int(k)] += weights[target] * offsets[i][k];
    }
}

void read_joints(Primitive& dst, Attributes& attributes)
{
    const size_t vertices = dst.positions.size();
    std::vector<Numbers> joints, weights;
    for (int set = 0; attributes.has(format("JOINTS_{}", set)) && attributes.has(format("WEIGHTS_{}", set)); ++set) {
        joints.push_back(attributes.read(format("JOINTS_{}", set), TINYGLTF_TYPE_VEC4, vertices));
        weights.push_back(attributes.read(format("WEIGHTS_{}", set), TINYGLTF_TYPE_VEC4, vertices));
        if (joints.back().count != vertices || weights.back().count != vertices)
            throw Error(format("JOINTS_{} or WEIGHTS_{} are not of {} vertices", set, set, vertices));
    }
    dst.influences = 4 * joints.size();
    for (size_t v = 0; v < vertices; ++v)
        for (size_t set = 0; set < joints.size(); ++set)
            for (size_t k = 0; k < 4; ++k) {
                dst.joints.push_back(uint32_t(std::clamp(joints[set][v][k], 0.0, 4294967295.0)));
                dst.weights.push_back(weights[set][v][k]);
            }
}

// The corners of triangle t of a strip or a fan turn the same way for each. Source: glTF 2.0, 3.7.2.1.
std::vector<std::array<uint32_t, 3>> triangles_of(const std::vector<uint32_t>& indices, int mode, Document& document,
                                                  const std::string& where)
{
    std::vector<std::array<uint32_t, 3>> triangles;
    const size_t count = indices.size();
    if (mode == TINYGLTF_MODE_TRIANGLES) {
        for (size_t i = 0; i + 2 < count; i += 3)
            triangles.push_back({ indices[i], indices[i + 1], indices[i + 2] });
        if (count % 3 != 0)
            document.builder().warn(
                format("{} has {} indices, which is no multiple of 3: the last are ignored", where, count));
    } else if (mode == TINYGLTF_MODE_TRIANGLE_STRIP) {
        for (size_t i = 0; i + 2 < count; ++i)
            triangles.push_back({ indices[i], indices[i + 1 + i % 2], indices[i + 2 - i % 2] });
    } else if (mode == TINYGLTF_MODE_TRIANGLE_FAN) {
        for (size_t i = 1; i + 1 < count; ++i)
            triangles.push_back({ indices[i], indices[i + 1], indices[0] });
    } else if (mode > TINYGLTF_MODE_TRIANGLE_FAN) {
        throw Error(format("unknown mode {}", mode));
    }
    return triangles;
}

} // namespace

Primitive read_primitive(Document& document, int mesh, int index, const std::vector<double>& weights, int uv_set,
                         bool with_skin)
{
    const tinygltf::Mesh& owner = document.model().meshes[size_t(mesh)];
    const tinygltf::Primitive& primitive = owner.primitives[size_t(index)];
    const std::string where = format("primitive {} of mesh \"{}\"", index, owner.name);
    const std::string uv_name = format("TEXCOORD_{}", uv_set);
    Primitive result;
    const bool has_triangles = primitive.mode < 0 || primitive.mode >= TINYGLTF_MODE_TRIANGLES;
    if (!has_triangles)
        return result;
    std::vector<std::string> wanted { "POSITION", "NORMAL", uv_name };
    for (int set = 0; with_skin && primitive.attributes.count(format("JOINTS_{}", set)); ++set) {
        wanted.push_back(format("JOINTS_{}", set));
        wanted.push_back(format("WEIGHTS_{}", set));
    }
    try {
        Attributes attributes(document, primitive, wanted);
        if (!attributes.has("POSITION"))
            return result; // legal, for extensions that supply it
        result.positions = to_vectors(attributes.read("POSITION", TINYGLTF_TYPE_VEC3, 0));
        const size_t vertices = result.positions.size();
        add_morph_targets(result.positions, document, primitive, "POSITION", TINYGLTF_TYPE_VEC3, weights);
        if (attributes.has("NORMAL")) {
            result.normals = to_vectors(attributes.read("NORMAL", TINYGLTF_TYPE_VEC3, vertices));
            add_morph_targets(result.normals, document, primitive, "NORMAL", TINYGLTF_TYPE_VEC3, weights);
        }
        if (attributes.has(uv_name)) {
            const Numbers numbers = attributes.read(uv_name, TINYGLTF_TYPE_VEC2, vertices);
            std::vector<V2d> uvs(vertices);
            for (size_t i = 0; i < vertices && i < numbers.count; ++i)
                uvs[i] = V2d(numbers[i][0], numbers[i][1]);
            add_morph_targets(uvs, document, primitive, uv_name, TINYGLTF_TYPE_VEC2, weights);
            restore_quantized_uvs(uvs, document, primitive, uv_set);
            for (const V2d& uv : uvs)
                result.uvs.push_back(V2f(float(uv.x), 1 - float(uv.y)));
        }
        if (with_skin)
            read_joints(result, attributes);
        const std::vector<uint32_t> indices = attributes.read_indices(vertices);
        for (size_t i = 0; i < indices.size(); ++i)
            if (indices[i] >= vertices)
                throw Error(format("index {} is vertex {}, but there are only {}", i, indices[i], vertices));
        result.triangles = triangles_of(indices, attributes.mode(), document, where);
    } catch (const Error& error) {
        throw Error(format("{}: {}", where, error.what()));
    }
    return result;
}

} // namespace vmlight::gltf
