// SPDX-License-Identifier: Apache-2.0
#include <vmlight/base/available_memory.h>
#include <vmlight/base/format.h>
#include <vmlight/base/text_format.h>
#include <vmlight/mesh/import/alembic.h>
#include <vmlight/mesh/import/alembic/error.h>
#include <vmlight/mesh/import/alembic/hierarchy.h>
#include <vmlight/mesh/import/alembic/mesh_parts.h>
#include <vmlight/mesh/import/alembic/poly_mesh.h>

#include <OpenImageIO/strutil.h>

#include <algorithm>
#include <string>
#include <unordered_map>
#include <utility>
#include <vector>

namespace vmlight {
namespace {

using namespace alembic;

bool is_mesh(const Object& object)
{
    return is_poly_mesh(object.reader->getHeader()) || is_subdivision_surface(object.reader->getHeader());
}

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
    Walk(MeshBuilder& dst, const ImportRequest& request)
        : m_dst(dst)
        , m_parts(dst)
        , m_hierarchy(request.path, dst.params(), dst.root_transform(false))
    {
        if (request.keeps_instances)
            count_shown();
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
        if (!is_mesh(object))
            return;
        if (!place.is_visible)
            m_hidden.push_back(object.reader->getFullName());
        else if (is_subdivision_surface(object.reader->getHeader()))
            m_subdivided.push_back(object.reader->getFullName());
        if (!place.is_visible)
            return;
        m_dst.mark_instance(uint32_t(place.named_node));
        append_mesh(object, name, place);
    }

    void append_mesh(const Object& object, const std::string& name, const Place& place)
    {
        if (const auto shown = m_shown.find(object.group); shown != m_shown.end() && shown->second > 1) {
            if (const uint32_t distinct = distinct_mesh(object); distinct != kEmpty)
                m_dst.add_place(distinct, place.to_object);
            return;
        }
        if (m_last_group != object.group) { // instances mostly follow each other
            m_last_group = 0;
            m_last = read_mesh(object);
            m_last_group = object.group;
        }
        check_memory(object, m_last.polygons);
        m_parts.append(m_last, name, place.to_object, uint32_t(place.node));
    }

    // How often each mesh is shown.
    void count_shown()
    {
        m_hierarchy.visit([](const std::string&, int) { return -1; },
                          [this](const Object& object, const std::string&, const Place& place) {
                              if (place.is_visible && is_mesh(object))
                                  ++m_shown[object.group];
                              return true;
                          });
    }

    // The number of a mesh that is shown in several places, to be held once; kEmpty if it has no triangles.
    uint32_t distinct_mesh(const Object& object)
    {
        const auto [known, is_new] = m_distinct.emplace(object.group, kEmpty);
        if (is_new) {
            const TriangulatedMesh mesh = read_mesh(object);
            check_memory(object, mesh.polygons);
            if (mesh.triangles.empty())
                return kEmpty;
            Mesh distinct;
            distinct.name = object.reader->getName();
            MeshBuilder own(distinct, m_dst.params());
            MeshParts(own).append(mesh, distinct.name, Imath::M44d(), own.add_node(distinct.name, -1));
            std::string error;
            if (!own.finish(error))
                throw Error(error);
            for (const std::string& warning : distinct.warnings)
                m_dst.warn(warning);
            known->second = m_dst.add_distinct(std::move(distinct));
        }
        return known->second;
    }

    // A short file may ask for a large mesh a million times.
    void check_memory(const Object& object, const PolyMesh& mesh)
    {
        m_vertices += mesh.faces.corners.size();
        const double bytes = double(mesh.positions.size()) * 44 + double(mesh.faces.ends.size()) * 24; // of Mesh
        if (m_vertices > UINT32_MAX || bytes > double(available_memory()))
            throw Error(format("\"{}\" is too large: with it there are {} corners, and {:.3g} GB of memory are left",
                               object.reader->getFullName(), m_vertices, double(available_memory()) * 1e-9));
    }

    TriangulatedMesh read_mesh(const Object& object)
    {
        const std::string& path = object.reader->getFullName();
        try {
            TriangulatedMesh mesh(read_poly_mesh(*object.reader, m_hierarchy.moment(), m_dst.params().uv_set));
            for (const std::string& fault : mesh.polygons.faults)
                m_dst.warn(format("\"{}\": {}", path, fault));
            return mesh;
        } catch (const alembic::Error& error) {
            throw Error(format("\"{}\": {}", path, error.what()));
        }
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

    static constexpr uint32_t kEmpty = ~0u;

    MeshBuilder& m_dst;
    MeshParts m_parts;
    Hierarchy m_hierarchy;
    uint64_t m_vertices = 0;
    std::vector<std::string> m_hidden, m_subdivided;
    uint64_t m_last_group = 0;
    TriangulatedMesh m_last;
    // By their groups: empty, or what count_shown() found; and the numbers of distinct meshes.
    std::unordered_map<uint64_t, size_t> m_shown;
    std::unordered_map<uint64_t, uint32_t> m_distinct;
};

} // namespace

bool read_alembic(MeshBuilder& dst, const ImportRequest& request, std::string& error)
{
    error = alembic_fault(request.head);
    if (!error.empty())
        return false;
    if (request.before_open)
        request.before_open(request.path);
    return without_errors(error, [&] { Walk(dst, request).append_all(); });
}

} // namespace vmlight
