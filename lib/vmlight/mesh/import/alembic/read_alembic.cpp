// SPDX-License-Identifier: Apache-2.0
#include <vmlight/base/available_memory.h>
#include <vmlight/base/format.h>
#include <vmlight/base/text_format.h>
#include <vmlight/base/unique_index.h>
#include <vmlight/mesh/import/alembic.h>
#include <vmlight/mesh/import/alembic/error.h>
#include <vmlight/mesh/import/alembic/hierarchy.h>
#include <vmlight/mesh/import/alembic/poly_mesh.h>
#include <vmlight/mesh/import/polygons.h>

#include <OpenImageIO/strutil.h>

#include <algorithm>
#include <array>
#include <map>
#include <string>
#include <utility>
#include <vector>

namespace vmlight {
namespace {

using namespace alembic;
using Imath::V2f;
using Imath::V3d;

struct Triangle
{
    uint32_t face;
    std::array<uint32_t, 3> corners;
};

std::string quoted_list(const std::vector<std::string>& names)
{
    constexpr size_t kMost = 3;
    std::vector<std::string> shown;
    for (size_t i = 0; i < std::min(names.size(), kMost); ++i)
        shown.push_back(format("\"{}\"", shortened_line(names[i])));
    return OIIO::Strutil::join(shown, ", ")
        + (names.size() > kMost ? format(" and {} more", names.size() - kMost) : "");
}

// Appends what the objects of an archive show to a builder.
class Walk
{
public:
    Walk(MeshBuilder& dst, const std::string& path)
        : m_dst(dst)
        , m_hierarchy(path, dst.params(), dst.root_transform(false))
    {
    }

    void append_all()
    {
        m_hierarchy.visit([this](const std::string& name, int parent) { return int(m_dst.add_node(name, parent)); },
                          [this](const Object& object, const std::string& name, const Place& place) {
                              append(object, name, place);
                              return true;
                          });
        if (!m_hidden.empty())
            m_dst.warn(format("hidden, so neither baked nor occluding: {}", quoted_list(m_hidden)));
        if (!m_subdivided.empty())
            m_dst.warn(format("subdivision surfaces, read as their control cages: {}", quoted_list(m_subdivided)));
        warn_of_frame();
    }

private:
    void append(const Object& object, const std::string& name, const Place& place)
    {
        const bool is_subdivided = is_subdivision_surface(object.reader->getHeader());
        if (!is_subdivided && !is_poly_mesh(object.reader->getHeader()))
            return;
        if (!place.is_visible)
            m_hidden.push_back(object.reader->getFullName());
        else if (is_subdivided)
            m_subdivided.push_back(object.reader->getFullName());
        if (place.is_visible)
            append_mesh(object, name, place);
    }

    void append_mesh(const Object& object, const std::string& name, const Place& place)
    {
        if (m_last_group != object.group) { // instances mostly follow each other
            m_last_group = 0;
            m_last = read_mesh(object);
            m_last_group = object.group;
        }
        const PolyMesh& mesh = m_last;
        m_vertices += mesh.faces.corners.size();
        const double bytes = double(mesh.positions.size()) * 44 + double(mesh.faces.ends.size()) * 24; // of Mesh
        if (m_vertices > UINT32_MAX || bytes > double(available_memory()))
            throw Error(format("\"{}\" is too large: with it there are {} corners, and {:.3g} GB of memory are left",
                               object.reader->getFullName(), m_vertices, double(available_memory()) * 1e-9));
        append_polygons(mesh, name, place);
    }

    PolyMesh read_mesh(const Object& object)
    {
        const std::string& path = object.reader->getFullName();
        try {
            PolyMesh mesh = read_poly_mesh(*object.reader, m_hierarchy.moment(), m_dst.params().uv_set);
            m_last_triangles = triangles_of(mesh);
            for (const std::string& fault : mesh.faults)
                m_dst.warn(format("\"{}\": {}", path, fault));
            return mesh;
        } catch (const alembic::Error& error) {
            throw Error(format("\"{}\": {}", path, error.what()));
        }
    }

    void append_polygons(const PolyMesh& mesh, const std::string& name, const Place& place)
    {
        struct Corner
        {
            uint32_t vertex, uv, normal;
        };
        UniqueIndex<Corner> vertices(mesh.faces.corners.size());
        size_t count = 0;
        m_dst.begin_part(name, place.to_object, uint32_t(place.parent));
        const auto vertex_of = [&](uint32_t corner) {
            const uint32_t vertex = mesh.faces.corners[corner];
            const uint32_t uv = mesh.uvs.exists() ? mesh.uvs.values[corner] : 0;
            const uint32_t normal = mesh.normals.exists() ? mesh.normals.values[corner] : 0;
            const uint32_t index = vertices.index_of({ vertex, uv, normal });
            if (index == count) {
                ++count;
                const float* n = mesh.normals.exists() ? &mesh.normals.numbers[3 * size_t(normal)] : nullptr;
                const float* t = mesh.uvs.exists() ? &mesh.uvs.numbers[2 * size_t(uv)] : nullptr;
                const V2f coordinates = t ? V2f(t[0], t[1]) : V2f(0);
                m_dst.add_vertex(mesh.positions[vertex], n ? V3d(n[0], n[1], n[2]) : V3d(0),
                                 t ? &coordinates : nullptr);
            }
            return index;
        };
        const std::vector<uint32_t> materials = materials_of(mesh);
        for (const Triangle& triangle : m_last_triangles) {
            const uint32_t a = vertex_of(triangle.corners[0]), b = vertex_of(triangle.corners[1]),
                           c = vertex_of(triangle.corners[2]);
            m_dst.add_triangle({ a, b, c }, materials[size_t(mesh.face_set[triangle.face] + 1)]);
        }
    }

    static std::vector<Triangle> triangles_of(const PolyMesh& mesh)
    {
        std::vector<Triangle> triangles;
        std::string error;
        const auto add = [&](size_t face, const std::array<uint32_t, 3>& corners) {
            if (mesh.is_hole.empty() || !mesh.is_hole[face])
                triangles.push_back({ uint32_t(face), corners });
        };
        if (!visit_triangles(
                mesh.faces.ends, [&](uint32_t corner) { return mesh.positions[mesh.faces.corners[corner]]; }, false,
                add, error))
            throw Error(error);
        return triangles;
    }

    // The material of faces without a face set, then those of the face sets: everywhere the same for one name.
    std::vector<uint32_t> materials_of(const PolyMesh& mesh)
    {
        std::vector<std::string> names { "" };
        names.insert(names.end(), mesh.face_sets.begin(), mesh.face_sets.end());
        std::vector<bool> used(names.size(), false);
        for (const int set : mesh.face_set)
            used[size_t(set + 1)] = true;
        std::vector<uint32_t> materials(names.size(), 0);
        for (size_t i = 0; i < names.size(); ++i) {
            if (!used[i])
                continue;
            auto known = m_materials.find(names[i]);
            if (known == m_materials.end()) {
                Material material;
                material.name = names[i];
                known = m_materials.emplace(names[i], m_dst.add_material(std::move(material))).first;
            }
            materials[i] = known->second;
        }
        return materials;
    }

    void warn_of_frame()
    {
        const MeshParams& params = m_dst.params();
        if (params.frame == MeshParams::kFirstSample)
            return;
        const Moment& moment = m_hierarchy.moment();
        const double first = moment.first() * params.fps, last = moment.last() * params.fps;
        constexpr double kHardly = 1e-3; // of a frame
        if (!(first <= last))
            m_dst.warn(format("frame {:.6g}: nothing is animated", params.frame));
        else if (params.frame < first - kHardly || params.frame > last + kHardly)
            m_dst.warn(format("frame {:.6g} is beyond the animation, which has frames {:.6g} to {:.6g} at {:.6g} per "
                              "second: its {} stands still",
                              params.frame, first, last, params.fps, params.frame < first ? "start" : "end"));
    }

    MeshBuilder& m_dst;
    Hierarchy m_hierarchy;
    uint64_t m_vertices = 0;
    std::map<std::string, uint32_t> m_materials;
    std::vector<std::string> m_hidden, m_subdivided;
    uint64_t m_last_group = 0;
    PolyMesh m_last;
    std::vector<Triangle> m_last_triangles;
};

} // namespace

bool read_alembic(MeshBuilder& dst, const ImportRequest& request, std::string& error)
{
    error = alembic_fault(request.head);
    if (!error.empty())
        return false;
    if (request.before_open)
        request.before_open(request.path);
    return without_errors(error, [&] { Walk(dst, request.path).append_all(); });
}

} // namespace vmlight
