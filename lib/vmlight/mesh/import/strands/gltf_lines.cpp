// SPDX-License-Identifier: Apache-2.0
#include <vmlight/base/available_memory.h>
#include <vmlight/base/format.h>
#include <vmlight/mesh/import/gltf/accessor.h>
#include <vmlight/mesh/import/gltf/document.h>
#include <vmlight/mesh/import/gltf/error.h>
#include <vmlight/mesh/import/gltf/hierarchy.h>
#include <vmlight/mesh/import/gltf/instances.h>
#include <vmlight/mesh/import/strands/strand_format.h>

#include <algorithm>
#include <numeric>

namespace vmlight {
namespace {

using Imath::M44d;
using Imath::V3d;

// Appends the line strips that the nodes of a document show.
class LineWalk
{
public:
    LineWalk(Strands& dst, gltf::Document& document)
        : m_strands(dst)
        , m_document(document)
        , m_model(document.model())
    {
    }

    void append_all()
    {
        const std::vector<int> roots = gltf::root_nodes(m_model);
        gltf::check_hierarchy(m_model, roots);
        m_transforms = gltf::node_transforms(m_model);
        for (const int root : roots)
            append_node(root);
        if (m_model.nodes.empty()) // a library of meshes
            for (const tinygltf::Mesh& mesh : m_model.meshes)
                append_mesh(mesh, mesh.weights, false, { M44d() });
        if (m_strands.ends.empty())
            throw gltf::Error("no strands: it shows no primitive of mode LINE_STRIP");
    }

private:
    // Recurses as deep as the hierarchy.
    void append_node(int index)
    {
        if (!gltf::is_node_visible(m_model, index))
            return;
        const tinygltf::Node& node = m_model.nodes[size_t(index)];
        if (node.mesh >= 0) {
            if (size_t(node.mesh) >= m_model.meshes.size())
                throw gltf::Error(
                    format("node {} has mesh {}, but there are only {}", index, node.mesh, m_model.meshes.size()));
            const tinygltf::Mesh& mesh = m_model.meshes[size_t(node.mesh)];
            std::vector<M44d> places;
            for (const M44d& instance : gltf::read_instances(m_document, node))
                places.push_back(instance * m_transforms[size_t(index)]);
            append_mesh(mesh, node.weights.empty() ? mesh.weights : node.weights, node.skin >= 0, places);
        }
        for (const int child : node.children)
            append_node(child);
    }

    void append_mesh(const tinygltf::Mesh& mesh, const std::vector<double>& weights, bool is_skinned,
                     const std::vector<M44d>& places)
    {
        for (const tinygltf::Primitive& primitive : mesh.primitives) {
            if (primitive.mode != TINYGLTF_MODE_LINE_STRIP || primitive.attributes.count("POSITION") == 0)
                continue;
            const bool is_morphed = !primitive.targets.empty()
                && std::any_of(weights.begin(), weights.end(), [](double weight) { return weight != 0; });
            if (is_skinned || is_morphed)
                throw gltf::Error(format("strands of mesh \"{}\" are {}, which is not read", mesh.name,
                                         is_skinned ? "skinned" : "morphed"));
            const gltf::Numbers& numbers = positions(primitive.attributes.at("POSITION"));
            std::vector<uint32_t> indices(numbers.count);
            std::iota(indices.begin(), indices.end(), 0u);
            if (primitive.indices >= 0)
                indices = gltf::read_indices(m_document, primitive.indices);
            for (const uint32_t index : indices)
                if (index >= numbers.count)
                    throw gltf::Error(format("a line of mesh \"{}\" uses vertex {}, but there are only {}", mesh.name,
                                             index, numbers.count));
            // A short file may ask for a line a million times.
            const double more = double(places.size()) * double(indices.size());
            if (double(m_strands.points.size()) + more > UINT32_MAX
                || more * (sizeof(V3d) + sizeof(double)) > double(available_memory()))
                throw gltf::Error(format("its lines have {:.6g} points, more than there is memory for", more));
            for (const M44d& place : places) {
                for (const uint32_t index : indices)
                    m_strands.points.push_back(V3d(numbers[index][0], numbers[index][1], numbers[index][2]) * place);
                end_strand(m_strands);
            }
        }
    }

    // Thousands of lines may share one array of points, which is read once.
    const gltf::Numbers& positions(int accessor)
    {
        if (m_accessor != accessor)
            m_positions = gltf::read_accessor(m_document, accessor, TINYGLTF_TYPE_VEC3, 0, "POSITION");
        m_accessor = accessor;
        return m_positions;
    }

    Strands& m_strands;
    gltf::Document& m_document;
    const tinygltf::Model& m_model;
    std::vector<M44d> m_transforms;
    gltf::Numbers m_positions {};
    int m_accessor = -1; // whose numbers m_positions are
};

} // namespace

namespace {

// Calls `use` with the document. False, with the reason in `error`, if it throws.
template <class Use> bool with_document(const StrandRequest& request, std::string& error, const Use& use)
{
    return gltf::without_errors(error, [&] {
        Mesh ignored; // takes the warnings of what a document has beside its lines
        MeshBuilder builder(ignored, request.params);
        const MeshFormat* const mesh_format = find_mesh_format(mesh_formats(), request.path, request.head);
        const ImportRequest whole { request.path, *mesh_format, request.head, {}, request.before_open };
        gltf::Document document(whole, builder);
        use(document);
    });
}

} // namespace

bool has_gltf_lines_alone(const StrandRequest& request)
{
    bool has_lines = false, has_others = false;
    std::string ignored;
    const auto look = [&](gltf::Document& document) {
        for (const tinygltf::Mesh& mesh : document.model().meshes)
            for (const tinygltf::Primitive& primitive : mesh.primitives)
                (primitive.mode == TINYGLTF_MODE_LINE_STRIP ? has_lines : has_others) = true;
    };
    return with_document(request, ignored, look) && has_lines && !has_others;
}

bool read_gltf_lines(Strands& dst, const StrandRequest& request, std::string& error)
{
    return with_document(request, error, [&](gltf::Document& document) { LineWalk(dst, document).append_all(); });
}

} // namespace vmlight
