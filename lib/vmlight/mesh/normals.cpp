// SPDX-License-Identifier: Apache-2.0
#include <vmlight/base/number_alike.h>
#include <vmlight/base/picked.h>
#include <vmlight/base/unique_index.h>
#include <vmlight/math/latlong.h>
#include <vmlight/mesh/mesh.h>
#include <vmlight/mesh/vertex_key.h>

#include <algorithm>
#include <cmath>
#include <numeric>

namespace vmlight {
namespace {

using Imath::V2f;
using Imath::V3d;
using Imath::V3f;

void take_vertices(Mesh& mesh, const std::vector<VertexKey>& vertices)
{
    const size_t count = vertices.size();
    const bool has_uvs = !mesh.uvs.empty();
    mesh.positions.resize(count);
    mesh.normals.resize(count);
    mesh.uvs.resize(has_uvs ? count : 0);
    for (size_t v = 0; v < count; ++v) {
        mesh.positions[v] = vertices[v].position;
        mesh.normals[v] = vertices[v].normal;
        if (has_uvs)
            mesh.uvs[v] = vertices[v].uv;
    }
}

// Rebuild the vertices from corners: corner_normal(t, triangle, k) is the normal of corner k of triangle t. At most
// `most` will differ.
template <class CornerNormal> void rebuild(Mesh& mesh, size_t most, const CornerNormal& corner_normal)
{
    most = std::min(most, mesh.triangles.size() * 3);
    UniqueIndex<VertexKey> vertices(most, std::min(most, mesh.positions.size()));
    const bool has_uvs = !mesh.uvs.empty();
    for (size_t t = 0; t < mesh.triangles.size(); ++t) {
        const std::array<uint32_t, 3> old = mesh.triangles[t]; // corner_normal() needs all three
        for (int k = 0; k < 3; ++k) {
            const uint32_t v = old[k];
            const VertexKey vertex { mesh.positions[v], corner_normal(t, old, k), has_uvs ? mesh.uvs[v] : V2f(0) };
            mesh.triangles[t][k] = vertices.index_of(vertex);
        }
    }
    take_vertices(mesh, vertices.keys());
}

double angle_between(const V3d& a, const V3d& b)
{
    return std::atan2(a.cross(b).length(), a.dot(b));
}

struct Corner
{
    uint32_t triangle, vertex;
    float angle;
};

/// Across which edges normals are smooth: see fill_missing_normals().
struct Smoothing
{
    Smoothing(double crease_angle, double seam_angle, const TriangleIndices& triangle_groups)
        : groups(triangle_groups)
        , least_cosine(least_cosine_of(crease_angle))
        , least_cosine_at_seams(least_cosine_of(seam_angle))
    {
    }

    const TriangleIndices& groups;
    double least_cosine, least_cosine_at_seams; // beyond any cosine: -2

private:
    static double least_cosine_of(double angle)
    {
        constexpr double kRounding = 1e-6; // of a dot product of unit vectors
        return angle >= 180 ? -2 : std::cos(angle * latlong::pi / 180) - kRounding;
    }
};

/// The corners at each position, and the unit normal of each triangle (zero without area).
struct TriangleFans
{
    std::vector<V3f> triangle_normals;
    std::vector<uint32_t> position_of_vertex;
    std::vector<uint32_t> first_corner; // position p has corners first_corner[p] .. first_corner[p + 1]
    std::vector<Corner> corners;

    explicit TriangleFans(const Mesh& mesh)
    {
        std::vector<uint32_t> first;
        const auto position = [&](size_t vertex) { return mesh.positions[vertex] + V3d(0); }; // -0 becomes 0
        position_of_vertex = number_alike(mesh.positions.size(), position, first);
        first_corner.assign(first.size() + 2, 0);
        for (const auto& triangle : mesh.triangles)
            for (uint32_t vertex : triangle)
                ++first_corner[position_of_vertex[vertex] + 2];
        std::partial_sum(first_corner.begin(), first_corner.end(), first_corner.begin());
        corners.resize(mesh.triangles.size() * 3);
        for (uint32_t t = 0; t < mesh.triangles.size(); ++t) {
            const auto& triangle = mesh.triangles[t];
            const V3d normal = triangle_area_normal(mesh, triangle).normalized();
            triangle_normals.push_back(V3f(normal));
            for (int k = 0; k < 3; ++k) {
                const V3d& p = mesh.positions[triangle[k]];
                const V3d to_next = mesh.positions[triangle[(k + 1) % 3]] - p;
                const V3d to_last = mesh.positions[triangle[(k + 2) % 3]] - p;
                corners[first_corner[position_of_vertex[triangle[k]] + 1]++]
                    = { t, triangle[k], float(angle_between(to_next, to_last)) };
            }
        }
        first_corner.pop_back();
    }

    V3f smooth_normal(const Mesh& mesh, uint32_t vertex, uint32_t triangle, const Smoothing& smoothing) const
    {
        const TriangleIndices& groups = smoothing.groups;
        if (!groups.empty() && groups[triangle] == kFlatGroup)
            return triangle_normals[triangle];
        const uint32_t position = position_of_vertex[vertex];
        const V3f& own = triangle_normals[triangle];
        const auto is_seam
            = [&](const Corner& corner) { return !mesh.uvs.empty() && mesh.uvs[corner.vertex] != mesh.uvs[vertex]; };
        V3d sum(0);
        double weight = 0;
        for (uint32_t c = first_corner[position]; c < first_corner[position + 1]; ++c) {
            if (!groups.empty() && groups[corners[c].triangle] != groups[triangle])
                continue;
            const V3f& other = triangle_normals[corners[c].triangle];
            double least = smoothing.least_cosine;
            if (is_seam(corners[c]))
                least = std::max(least, smoothing.least_cosine_at_seams);
            const bool joins = corners[c].triangle == triangle || own.length2() == 0 || own.dot(other) >= least;
            if (joins) {
                sum += V3d(other) * corners[c].angle;
                weight += corners[c].angle;
            }
        }
        // Faces back to back cancel out to rounding noise: use the triangle's own normal.
        return sum.length() > 1e-6 * weight ? V3f(sum.normalized()) : own;
    }
};

} // namespace

void make_flat_normals(Mesh& mesh)
{
    rebuild(mesh, mesh.triangles.size() * 3,
            [&](size_t, const auto& triangle, int) { return V3f(triangle_area_normal(mesh, triangle).normalized()); });
}

void make_smooth_normals(Mesh& mesh, double crease_angle)
{
    mesh.normals.assign(mesh.positions.size(), V3f(0));
    fill_missing_normals(mesh, crease_angle);
}

void fill_missing_normals(Mesh& mesh, double crease_angle, const TriangleIndices& groups, double seam_angle)
{
    if (std::none_of(mesh.normals.begin(), mesh.normals.end(), is_missing_normal)) {
        merge_equal_vertices(mesh);
        return;
    }
    const TriangleFans fans(mesh);
    const Smoothing smoothing(crease_angle, seam_angle, groups);
    rebuild(mesh, mesh.triangles.size() * 3, [&](size_t t, const auto& triangle, int k) {
        const uint32_t vertex = triangle[k];
        const V3f& normal = mesh.normals[vertex];
        return is_missing_normal(normal) ? fans.smooth_normal(mesh, vertex, uint32_t(t), smoothing) : normal;
    });
}

void merge_equal_vertices(Mesh& mesh)
{
    constexpr uint32_t kNone = ~0u;
    const size_t count = mesh.positions.size();
    const bool has_uvs = !mesh.uvs.empty();
    const std::vector<uint32_t> first = first_alike(count, [&](size_t v) {
        return VertexKey { mesh.positions[v], mesh.normals[v], has_uvs ? mesh.uvs[v] : V2f(0) };
    });
    std::vector<uint32_t> numbers(count, kNone), kept;
    kept.reserve(count);
    for (auto& triangle : mesh.triangles)
        for (uint32_t& vertex : triangle) {
            uint32_t& number = numbers[first[vertex]];
            if (number == kNone) {
                number = uint32_t(kept.size());
                kept.push_back(first[vertex]);
            }
            vertex = number;
        }
    mesh.positions = picked(mesh.positions, kept);
    mesh.normals = picked(mesh.normals, kept);
    if (has_uvs)
        mesh.uvs = picked(mesh.uvs, kept);
}

} // namespace vmlight
