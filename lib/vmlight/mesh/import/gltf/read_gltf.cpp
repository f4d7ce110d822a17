// SPDX-License-Identifier: Apache-2.0
#include <vmlight/base/available_memory.h>
#include <vmlight/base/format.h>
#include <vmlight/base/text_format.h>
#include <vmlight/mesh/import/format_checks.h>
#include <vmlight/mesh/import/gltf.h>
#include <vmlight/mesh/import/gltf/camera.h>
#include <vmlight/mesh/import/gltf/document.h>
#include <vmlight/mesh/import/gltf/hierarchy.h>
#include <vmlight/mesh/import/gltf/instances.h>
#include <vmlight/mesh/import/gltf/material.h>
#include <vmlight/mesh/import/gltf/primitive.h>
#include <vmlight/mesh/import/gltf/skin.h>

#include <OpenImageIO/strutil.h>

#include <map>
#include <string>
#include <utility>
#include <vector>

namespace vmlight {
namespace {

using namespace gltf;
using Imath::M44d;
using Imath::V3d;

// Appends what the nodes of a document show to its builder.
class Walk
{
public:
    Walk(Document& document, bool keeps_instances)
        : m_document(document)
        , m_model(document.model())
        , m_roots(root_nodes(m_model))
    {
        check_hierarchy(m_model, m_roots);
        m_transforms = node_transforms(m_model);
        if (!keeps_instances)
            return;
        m_shown.assign(m_model.meshes.size(), 0);
        for (const int root : m_roots)
            count_shown(root);
    }

    void append_all()
    {
        const M44d to_object = m_document.builder().root_transform(false);
        for (const int root : m_roots)
            append_node(root, -1, to_object);
        if (m_model.nodes.empty()) // a library of meshes
            for (size_t mesh = 0; mesh < m_model.meshes.size(); ++mesh)
                append_mesh(int(mesh), m_model.meshes[mesh].weights, -1,
                            m_document.builder().add_node(m_model.meshes[mesh].name, -1), { to_object });
    }

private:
    // Recurses as deep as the hierarchy.
    void append_node(int index, int parent, const M44d& to_object)
    {
        if (!is_node_visible(m_model, index))
            return;
        const tinygltf::Node& node = m_model.nodes[size_t(index)];
        const uint32_t number = m_document.builder().add_node(node.name, parent);
        if (node.camera >= 0)
            add_camera(node, m_transforms[size_t(index)] * to_object);
        if (node.mesh >= 0) {
            if (size_t(node.mesh) >= m_model.meshes.size())
                throw Error(
                    format("node {} has mesh {}, but there are only {}", index, node.mesh, m_model.meshes.size()));
            m_document.builder().mark_instance(number);
            std::vector<M44d> places;
            if (node.skin >= 0)
                places = { to_object };
            else
                for (const M44d& instance : read_instances(m_document, node))
                    places.push_back(instance * m_transforms[size_t(index)] * to_object);
            append_mesh(node.mesh, node.weights.empty() ? m_model.meshes[size_t(node.mesh)].weights : node.weights,
                        node.skin, number, places);
        }
        for (const int child : node.children)
            append_node(child, int(number), to_object);
    }

    // How many nodes show each mesh; one with instances counts as several.
    void count_shown(int index)
    {
        if (!is_node_visible(m_model, index))
            return;
        const tinygltf::Node& node = m_model.nodes[size_t(index)];
        if (node.mesh >= 0 && size_t(node.mesh) < m_shown.size() && node.skin < 0)
            m_shown[size_t(node.mesh)] += node.extensions.count("EXT_mesh_gpu_instancing") ? 2 : 1;
        for (const int child : node.children)
            count_shown(child);
    }

    // A mesh that is shown in several places, to be held once.
    void add_places(int mesh, const std::vector<double>& weights, const std::vector<M44d>& places)
    {
        MeshBuilder& builder = m_document.builder();
        const auto [known, is_new] = m_distinct.emplace(std::make_pair(mesh, weights), 0);
        if (is_new) {
            Mesh distinct;
            distinct.name = m_model.meshes[size_t(mesh)].name;
            MeshBuilder own(distinct, builder.params());
            const std::vector<Primitive> parts = read_parts(mesh, weights, -1);
            check_memory(parts, 1);
            const uint32_t node = own.add_node(distinct.name, -1);
            for (const Material& material : builder.materials())
                own.add_material(material);
            size_t triangles = 0;
            for (size_t i = 0; i < parts.size(); ++i) {
                append_part(own, parts[i], m_model.meshes[size_t(mesh)].primitives[i].material, distinct.name, node,
                            M44d());
                triangles += parts[i].triangles.size();
            }
            std::string error;
            if (triangles > 0 && !own.finish(error))
                throw Error(error);
            for (const std::string& warning : distinct.warnings)
                builder.warn(warning);
            known->second = builder.add_distinct(std::move(distinct));
        }
        for (const M44d& place : places)
            builder.add_place(known->second, place);
    }

    // What is wrong with a camera does not keep the mesh from being read.
    void add_camera(const tinygltf::Node& node, const M44d& to_object)
    {
        try {
            m_document.builder().add_camera(read_camera(m_document.cameras(), node, to_object));
        } catch (const gltf::Error& reason) {
            m_document.builder().warn(shortened_line(reason.what()) + "; it is left out");
        }
    }

    void append_mesh(int mesh, const std::vector<double>& weights, int skin, uint32_t node,
                     const std::vector<M44d>& places)
    {
        if (!m_shown.empty() && skin < 0 && m_shown[size_t(mesh)] > 1) {
            add_places(mesh, weights, places);
            return;
        }
        const auto& primitives = m_model.meshes[size_t(mesh)].primitives;
        const bool is_last = mesh == m_last_mesh && weights == m_last_weights && skin < 0;
        std::vector<Primitive> parts = is_last ? std::move(m_last_parts) : read_parts(mesh, weights, skin);
        check_memory(parts, places.size());
        for (const M44d& place : places)
            for (size_t i = 0; i < parts.size(); ++i)
                append_part(m_document.builder(), parts[i], primitives[i].material, m_model.meshes[size_t(mesh)].name,
                            node, place);
        m_last_mesh = skin < 0 ? mesh : -1;
        m_last_weights = weights;
        m_last_parts = std::move(parts);
    }

    std::vector<Primitive> read_parts(int mesh, const std::vector<double>& weights, int skin)
    {
        std::vector<Primitive> parts;
        for (size_t i = 0; i < m_model.meshes[size_t(mesh)].primitives.size(); ++i) {
            parts.push_back(
                read_primitive(m_document, mesh, int(i), weights, m_document.builder().params().uv_set, skin >= 0));
            if (skin >= 0)
                apply_skin(parts.back(), m_document, skin, m_transforms);
        }
        return parts;
    }

    void append_part(MeshBuilder& builder, const Primitive& part, int material, const std::string& name, uint32_t node,
                     const M44d& place)
    {
        const size_t materials = m_model.materials.size(); // the one after them is for parts without
        builder.begin_part(name, place, node);
        for (size_t v = 0; v < part.positions.size(); ++v)
            builder.add_vertex(part.positions[v], part.normals.empty() ? V3d(0) : part.normals[v],
                               part.uvs.empty() ? nullptr : &part.uvs[v]);
        for (const auto& triangle : part.triangles)
            builder.add_triangle(
                triangle, uint32_t(material >= 0 && size_t(material) < materials ? material : materials), kFlatGroup);
    }

    // A short file may ask for a large mesh a million times.
    static void check_memory(const std::vector<Primitive>& parts, size_t copies)
    {
        double vertices = 0, triangles = 0;
        for (const Primitive& part : parts) {
            vertices += double(copies) * double(part.positions.size());
            triangles += double(copies) * double(part.triangles.size());
        }
        const double bytes = vertices * 44 + triangles * 24; // of Mesh
        if (vertices > UINT32_MAX || bytes > double(available_memory()))
            throw Error(format("{:.6g} vertices and {:.6g} triangles need {:.3g} GB of memory, {:.3g} available",
                               vertices, triangles, bytes * 1e-9, double(available_memory()) * 1e-9));
    }

    Document& m_document;
    const tinygltf::Model& m_model;
    const std::vector<int> m_roots;
    std::vector<M44d> m_transforms;
    // Nodes that show the same mesh mostly follow each other: it is decompressed once.
    int m_last_mesh = -1;
    std::vector<double> m_last_weights;
    std::vector<Primitive> m_last_parts;
    // Empty, or what count_shown() found; and distinct meshes by their number and weights of morph targets.
    std::vector<size_t> m_shown;
    std::map<std::pair<int, std::vector<double>>, uint32_t> m_distinct;
};

} // namespace

bool is_gltf(const FileHead& head)
{
    const OIIO::string_view text = first_text(head);
    return OIIO::Strutil::starts_with(head.bytes, "glTF")
        || (OIIO::Strutil::starts_with(text, "{") && OIIO::Strutil::contains(text, "\"asset\""));
}

bool read_gltf(MeshBuilder& dst, const ImportRequest& request, std::string& error)
{
    return gltf::without_errors(error, [&] {
        Document document(request, dst);
        add_materials(document);
        Walk(document, request.keeps_instances).append_all();
        if (document.animations() > 0)
            dst.warn(format("{} not played: nodes stay as they are; bake other poses from a file each, or from Alembic",
                            count_text(int64_t(document.animations()), "animation is", "animations are")));
    });
}

} // namespace vmlight
