// SPDX-License-Identifier: Apache-2.0
#include <vmlight/base/text_format.h>
#include <vmlight/base/utf8.h>
#include <vmlight/mesh/export/exporter.h>
#include <vmlight/mesh/export/gltf_model.h>

#include <Imath/ImathBox.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <map>
#include <numeric>
#include <sstream>

namespace vmlight {
namespace {

using Imath::V2f;
using Imath::V3d;
using Imath::V3f;

// Where floats hold the positions: (p - origin) / scale.
struct Frame
{
    V3d origin { 0 };
    double scale = 1;
};

Frame frame_of(const std::vector<V3d>& points)
{
    Imath::Box3d bounds;
    bool are_floats = true;
    for (const V3d& p : points) {
        bounds.extendBy(p);
        are_floats = are_floats && V3d(V3f(p)) == p;
    }
    Frame frame;
    if (are_floats)
        return frame;
    frame.origin = bounds.center();
    const V3d size = bounds.size();
    const double longest = std::max({ size.x, size.y, size.z });
    if (longest > 1e30 || longest < 1e-30)
        frame.scale = std::exp2(std::ilogb(longest)); // exact
    return frame;
}

template <class Element>
int add_array(tinygltf::Model& model, const std::vector<Element>& elements, int component, int type, int target)
{
    tinygltf::Accessor accessor;
    accessor.bufferView = add_buffer_view(model, elements.data(), elements.size() * sizeof(Element), target);
    accessor.componentType = component;
    accessor.count = elements.size();
    accessor.type = type;
    model.accessors.push_back(accessor);
    return int(model.accessors.size()) - 1;
}

int add_positions(tinygltf::Model& model, const std::vector<V3d>& points, const Frame& frame)
{
    std::vector<V3f> positions;
    V3f low(INFINITY), high(-INFINITY);
    for (const V3d& p : points) {
        positions.push_back(V3f((p - frame.origin) / frame.scale));
        for (int axis = 0; axis < 3; ++axis) {
            low[axis] = std::min(low[axis], positions.back()[axis]);
            high[axis] = std::max(high[axis], positions.back()[axis]);
        }
    }
    const int index
        = add_array(model, positions, TINYGLTF_COMPONENT_TYPE_FLOAT, TINYGLTF_TYPE_VEC3, TINYGLTF_TARGET_ARRAY_BUFFER);
    model.accessors[size_t(index)].minValues = { low.x, low.y, low.z };
    model.accessors[size_t(index)].maxValues = { high.x, high.y, high.z };
    return index;
}

int add_normals(tinygltf::Model& model, const Mesh& mesh)
{
    std::vector<V3f> normals = mesh.normals;
    for (V3f& normal : normals)
        if (is_missing_normal(normal))
            normal = V3f(0, 1, 0); // of triangles without area: glTF wants one of unit length
    return add_array(model, normals, TINYGLTF_COMPONENT_TYPE_FLOAT, TINYGLTF_TYPE_VEC3, TINYGLTF_TARGET_ARRAY_BUFFER);
}

int add_uvs(tinygltf::Model& model, const Mesh& mesh)
{
    std::vector<V2f> uvs;
    for (uint32_t vertex = 0; vertex < mesh.uvs.size(); ++vertex) {
        const V2f& uv = mesh.uvs[vertex];
        uvs.push_back(has_uv(mesh, vertex) ? V2f(uv.x, 1 - uv.y) : V2f(0)); // v is down in glTF
    }
    return add_array(model, uvs, TINYGLTF_COMPONENT_TYPE_FLOAT, TINYGLTF_TYPE_VEC2, TINYGLTF_TARGET_ARRAY_BUFFER);
}

// A model of one mesh, without primitives yet.
tinygltf::Model model_of(const std::string& name, const Frame& frame)
{
    tinygltf::Model model;
    model.asset.version = "2.0";
    model.asset.generator = "vmlight";
    tinygltf::Node& node = model.nodes.emplace_back();
    node.name = model.meshes.emplace_back().name = is_utf8(name) ? name : printable_line(name);
    node.mesh = 0;
    if (frame.origin != V3d(0))
        node.translation = { frame.origin.x, frame.origin.y, frame.origin.z };
    if (frame.scale != 1)
        node.scale = { frame.scale, frame.scale, frame.scale };
    model.scenes.emplace_back().nodes = { 0 };
    model.defaultScene = 0;
    return model;
}

tinygltf::Material gltf_material(const Material& material)
{
    tinygltf::Material result;
    result.name = is_utf8(material.name) ? material.name : printable_line(material.name);
    const Imath::Color4f& color = material.base_color;
    result.pbrMetallicRoughness.baseColorFactor = { color.r, color.g, color.b, color.a };
    result.pbrMetallicRoughness.metallicFactor = 0;
    result.doubleSided = material.is_double_sided;
    if (material.alpha_mode != AlphaMode::opaque)
        result.alphaMode = material.alpha_mode == AlphaMode::mask ? "MASK" : "BLEND";
    result.alphaCutoff = double(material.alpha_cutoff);
    return result;
}

// Corners by material, and whether they have UVs: those that have none are a primitive without.
std::map<std::pair<uint32_t, bool>, std::vector<uint32_t>> indices_of(const Mesh& mesh)
{
    std::map<std::pair<uint32_t, bool>, std::vector<uint32_t>> indices;
    for (size_t t = 0; t < mesh.triangles.size(); ++t) {
        const auto& triangle = mesh.triangles[t];
        const bool with_uv
            = std::all_of(triangle.begin(), triangle.end(), [&](uint32_t vertex) { return has_uv(mesh, vertex); });
        const uint32_t material = t < mesh.triangle_materials.size() ? mesh.triangle_materials[t] : 0;
        std::vector<uint32_t>& corners = indices[{ material, !with_uv }];
        corners.insert(corners.end(), triangle.begin(), triangle.end());
    }
    return indices;
}

} // namespace

int add_buffer_view(tinygltf::Model& model, const void* bytes, size_t size, int target)
{
    model.buffers.resize(1);
    std::vector<unsigned char>& buffer = model.buffers[0].data;
    buffer.resize((buffer.size() + 3) / 4 * 4); // floats are aligned
    tinygltf::BufferView view;
    view.buffer = 0;
    view.byteOffset = buffer.size();
    view.byteLength = size;
    view.target = target;
    buffer.resize(buffer.size() + size);
    std::memcpy(buffer.data() + view.byteOffset, bytes, size);
    model.bufferViews.push_back(view);
    return int(model.bufferViews.size()) - 1;
}

tinygltf::Model gltf_model(const Mesh& mesh)
{
    const Frame frame = frame_of(mesh.positions);
    tinygltf::Model model = model_of(mesh.name, frame);
    const int positions = add_positions(model, mesh.positions, frame), normals = add_normals(model, mesh);
    const int uvs = mesh.uvs.empty() ? -1 : add_uvs(model, mesh);
    for (const Material& material : mesh.materials)
        model.materials.push_back(gltf_material(material));

    for (const auto& [kind, corners] : indices_of(mesh)) {
        tinygltf::Primitive& part = model.meshes[0].primitives.emplace_back();
        part.mode = TINYGLTF_MODE_TRIANGLES;
        part.attributes = { { "POSITION", positions }, { "NORMAL", normals } };
        if (!kind.second)
            part.attributes["TEXCOORD_0"] = uvs;
        part.indices = add_array(model, corners, TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT, TINYGLTF_TYPE_SCALAR,
                                 TINYGLTF_TARGET_ELEMENT_ARRAY_BUFFER);
        part.material = kind.first < model.materials.size() ? int(kind.first) : -1;
    }
    return model;
}

std::string glb_bytes(tinygltf::Model& model)
{
    std::ostringstream stream;
    tinygltf::TinyGLTF().WriteGltfSceneToStream(&model, stream, false, true);
    return stream.str();
}

std::vector<MeshFile> gltf_files(const Mesh& mesh, const std::string& path)
{
    tinygltf::Model model = gltf_model(mesh);
    return { { path, glb_bytes(model) } };
}

std::vector<MeshFile> gltf_strand_files(const Strands& strands, const std::vector<V2f>& uvs, const std::string& path)
{
    const Frame frame = frame_of(strands.points);
    tinygltf::Model model = model_of(strands.name, frame);
    const int positions = add_positions(model, strands.points, frame);
    std::vector<V2f> downwards;
    for (const V2f& uv : uvs)
        downwards.emplace_back(uv.x, 1 - uv.y);
    const int lookups
        = add_array(model, downwards, TINYGLTF_COMPONENT_TYPE_FLOAT, TINYGLTF_TYPE_VEC2, TINYGLTF_TARGET_ARRAY_BUFFER);
    std::vector<uint32_t> numbers(strands.points.size());
    std::iota(numbers.begin(), numbers.end(), 0u);
    const int all = add_buffer_view(model, numbers.data(), numbers.size() * sizeof(uint32_t),
                                    TINYGLTF_TARGET_ELEMENT_ARRAY_BUFFER);
    for (size_t strand = 0; strand < strands.count(); ++strand) {
        tinygltf::Accessor points;
        points.bufferView = all;
        points.byteOffset = strands.begin(strand) * sizeof(uint32_t);
        points.componentType = TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT;
        points.count = strands.end(strand) - strands.begin(strand);
        points.type = TINYGLTF_TYPE_SCALAR;
        tinygltf::Primitive& line = model.meshes[0].primitives.emplace_back();
        line.mode = TINYGLTF_MODE_LINE_STRIP;
        line.attributes = { { "POSITION", positions }, { "TEXCOORD_0", lookups } };
        line.indices = int(model.accessors.size());
        model.accessors.push_back(points);
    }
    return { { path, glb_bytes(model) } };
}

} // namespace vmlight
