// SPDX-License-Identifier: Apache-2.0
#include <vmlight/mesh/tangents.h>

#include <vmlight/base/unique_index.h>
#include <vmlight/base/work_counts.h>
#include <vmlight/mesh/vertex_key.h>

#include <algorithm>
#include <cmath>
#include <tuple>
#include <utility>

namespace vmlight {
namespace {

using Imath::V2d;
using Imath::V2f;
using Imath::V3d;
using Imath::V3f;

constexpr int kNone = -1;
// Volume of a frame whose axes are in one plane.
constexpr double kFlatSpace = 1e-6;

struct TangentFace
{
    std::array<uint32_t, 3> vertices;
    /// The face across the edge from corner k to the next one.
    std::array<int, 3> across { kNone, kNone, kNone };
    std::array<bool, 3> has_tangent {};
    /// Along +u.
    V3d direction { 0 };
    /// Whether the texture is seen from its front.
    bool is_upright = true;
    /// No area in uv: it goes with either side, and has no direction of its own.
    bool is_neutral = true;
    /// No area: it connects nothing.
    bool is_degenerate = true;
};

double or_one(double length)
{
    return length > 0 ? length : 1;
}

V3d on_plane(const V3d& v, const V3d& normal)
{
    const V3d flat = v - normal * normal.dot(v);
    return flat / or_one(flat.length());
}

class TangentMesh
{
public:
    explicit TangentMesh(const Mesh& mesh)
        : m_welded(mesh.triangles.size() * 3)
        , m_faces(mesh.triangles.size())
        , m_tangents(mesh.triangles.size())
    {
        for (size_t t = 0; t < m_faces.size(); ++t)
            add_face(m_faces[t], mesh, mesh.triangles[t]);
        connect();
    }

    std::vector<std::array<CornerTangent, 3>> tangents()
    {
        for (int face = 0; face < int(m_faces.size()); ++face)
            for (int corner = 0; corner < 3; ++corner)
                if (!m_faces[face].is_neutral && !m_faces[face].is_degenerate && !m_faces[face].has_tangent[corner])
                    fill_from(face, corner);
        return std::move(m_tangents);
    }

private:
    using Corner = std::pair<int, int>; // of a face

    const VertexKey& vertex(const TangentFace& face, int corner) const
    {
        return m_welded.keys()[face.vertices[corner]];
    }

    void add_face(TangentFace& face, const Mesh& mesh, const std::array<uint32_t, 3>& triangle)
    {
        const V3f zero(0); // makes +0 of -0
        for (int k = 0; k < 3; ++k) {
            const uint32_t v = triangle[k];
            face.vertices[k]
                = m_welded.index_of({ mesh.positions[v] + V3d(zero), mesh.normals[v] + zero, mesh.uvs[v] + V2f(0, 0) });
        }
        const VertexKey a = vertex(face, 0), b = vertex(face, 1), c = vertex(face, 2);
        face.is_degenerate = a.position == b.position || b.position == c.position || c.position == a.position;
        const V2d ab(V2d(b.uv) - V2d(a.uv)), ac(V2d(c.uv) - V2d(a.uv));
        const double area = ab.x * ac.y - ab.y * ac.x;
        if (!(std::abs(area) > 0)) // or not a number
            return;
        const V3d to_b = b.position - a.position, to_c = c.position - a.position;
        const V3d along_u = to_b * ac.y - to_c * ab.y, along_v = to_c * ab.x - to_b * ac.x;
        face.is_upright = area > 0;
        face.is_neutral = !(along_u.length() > 0 && along_v.length() > 0);
        face.direction = along_u / (or_one(along_u.length()) * (area > 0 ? 1 : -1));
    }

    // Faces that run along an edge in opposite directions.
    void connect()
    {
        struct Edge
        {
            uint32_t low, high;
            int face, corner;
        };
        std::vector<Edge> edges;
        edges.reserve(m_faces.size() * 3);
        for (int face = 0; face < int(m_faces.size()); ++face)
            for (int k = 0; k < 3 && !m_faces[face].is_degenerate; ++k) {
                const uint32_t from = m_faces[face].vertices[k], to = m_faces[face].vertices[(k + 1) % 3];
                edges.push_back({ std::min(from, to), std::max(from, to), face, k });
            }
        std::sort(edges.begin(), edges.end(), [](const Edge& a, const Edge& b) {
            return std::tie(a.low, a.high, a.face, a.corner) < std::tie(b.low, b.high, b.face, b.corner);
        });
        const auto starts_low = [&](const Edge& e) { return m_faces[e.face].vertices[e.corner] == e.low; };
        for (size_t i = 0; i < edges.size(); ++i)
            for (size_t j = i + 1; j < edges.size() && edges[j].low == edges[i].low && edges[j].high == edges[i].high;
                 ++j) {
                int &mine = m_faces[edges[i].face].across[edges[i].corner],
                    &other = m_faces[edges[j].face].across[edges[j].corner];
                if (mine == kNone && other == kNone && starts_low(edges[i]) != starts_low(edges[j])) {
                    mine = edges[j].face;
                    other = edges[i].face;
                }
            }
    }

    // All corners around a vertex that share the tangent of this one get it.
    void fill_from(int first_face, int first_corner)
    {
        const uint32_t shared = m_faces[first_face].vertices[first_corner];
        const bool is_upright = m_faces[first_face].is_upright;
        std::vector<Corner> group;
        std::vector<int> pending { first_face };
        while (!pending.empty()) {
            const int index = pending.back();
            pending.pop_back();
            TangentFace& face = m_faces[index];
            const int corner
                = int(std::find(face.vertices.begin(), face.vertices.end(), shared) - face.vertices.begin());
            if (corner == 3 || face.has_tangent[corner])
                continue;
            // Whoever comes first decides for a face that may go with either.
            if (face.is_neutral && !face.has_tangent[0] && !face.has_tangent[1] && !face.has_tangent[2])
                face.is_upright = is_upright;
            if (face.is_upright != is_upright)
                continue;
            face.has_tangent[corner] = true;
            group.emplace_back(index, corner);
            for (const int edge : { corner, (corner + 2) % 3 })
                if (face.across[edge] != kNone)
                    pending.push_back(face.across[edge]);
        }
        const CornerTangent mean { V3f(mean_direction(group)), is_upright ? 1.0f : -1.0f };
        for (const auto& [face, corner] : group)
            m_tangents[size_t(face)][size_t(corner)] = mean;
    }

    V3d mean_direction(const std::vector<Corner>& group) const
    {
        V3d sum(0);
        for (const auto& [index, corner] : group) {
            const TangentFace& face = m_faces[index];
            if (face.is_neutral)
                continue;
            const VertexKey& here = vertex(face, corner);
            const V3d normal(here.normal);
            const V3d to_next = on_plane(vertex(face, (corner + 1) % 3).position - here.position, normal);
            const V3d to_last = on_plane(vertex(face, (corner + 2) % 3).position - here.position, normal);
            sum += on_plane(face.direction, normal) * std::acos(std::clamp(to_next.dot(to_last), -1.0, 1.0));
        }
        return sum / or_one(sum.length());
    }

    UniqueIndex<VertexKey> m_welded;
    std::vector<TangentFace> m_faces;
    std::vector<std::array<CornerTangent, 3>> m_tangents;
};

} // namespace

std::vector<std::array<CornerTangent, 3>> make_tangents(const Mesh& mesh)
{
    ++work_counts().tangents_made;
    return TangentMesh(mesh).tangents();
}

V3d TangentSpace::from_object(const V3d& v) const
{
    const V3d across = bitangent.cross(normal);
    const double volume = tangent.dot(across);
    if (!(std::abs(volume) > kFlatSpace)) // or not a number
        return V3d(0);
    return V3d(v.dot(across), v.dot(normal.cross(tangent)), v.dot(tangent.cross(bitangent))) / volume;
}

TangentSpace tangent_space(const Mesh& mesh, const std::array<uint32_t, 3>& triangle,
                           const std::array<CornerTangent, 3>& corners, float weight1, float weight2)
{
    const std::array<double, 3> weights { 1.0 - double(weight1) - double(weight2), double(weight1), double(weight2) };
    TangentSpace frame { V3d(0), V3d(0), V3d(0) };
    for (size_t k = 0; k < 3; ++k) {
        frame.normal += V3d(mesh.normals[triangle[k]]) * weights[k];
        frame.tangent += V3d(corners[k].tangent) * weights[k];
    }
    frame.bitangent = frame.normal.cross(frame.tangent) * double(corners[0].sign);
    return frame;
}

} // namespace vmlight
