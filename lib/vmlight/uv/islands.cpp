// SPDX-License-Identifier: Apache-2.0
#include <vmlight/uv/islands.h>

#include <vmlight/base/disjoint_sets.h>
#include <vmlight/base/number_alike.h>

#include <atomic>
#include <utility>

namespace vmlight {
namespace {

/// Vertices with the same texture coordinates are one point.
struct UvPoints
{
    explicit UvPoints(const Mesh& mesh)
    {
        const auto point = [&](size_t vertex) { return mesh.uvs[vertex] + Imath::V2f(0); }; // -0 becomes 0
        std::vector<uint32_t> first;
        of_vertex = number_alike(mesh.uvs.size(), point, first);
        count = first.size();
    }
    std::vector<uint32_t> of_vertex;
    size_t count;
};

/// The islands that some triangles form.
class Islands
{
public:
    /// @param takes(triangle)   whether it is one of them; thread-safe
    template <class Takes>
    Islands(const Mesh& mesh, const Takes& takes)
        : m_mesh(mesh)
        , m_points(mesh)
        , m_sets(m_points.count)
    {
        parallel_blocks(mesh.triangles.size(), [&](size_t begin, size_t end, size_t) {
            for (size_t t = begin; t < end; ++t) {
                if (!takes(uint32_t(t)))
                    continue;
                const auto& [a, b, c] = mesh.triangles[t];
                m_sets.join(m_points.of_vertex[a], m_points.of_vertex[b]);
                m_sets.join(m_points.of_vertex[a], m_points.of_vertex[c]);
            }
        });
    }

    /// Numbers of islands are below this.
    size_t end() const { return m_points.count; }
    uint32_t of_triangle(size_t triangle) { return m_sets.find(m_points.of_vertex[m_mesh.triangles[triangle][0]]); }

private:
    const Mesh& m_mesh;
    const UvPoints m_points;
    DisjointSets m_sets;
};

} // namespace

void count_islands(UvReport& report, const Mesh& mesh, const UvRaster& raster)
{
    std::vector<uint8_t> is_in_tile(mesh.triangles.size());
    Islands islands(mesh, [&](uint32_t triangle) { return is_in_tile[triangle] = raster.is_in_tile(triangle); });
    std::vector<std::atomic<bool>> covers(islands.end());
    std::vector<std::atomic<uint32_t>> triangles(islands.end());
    parallel_blocks(mesh.triangles.size(), [&](size_t begin, size_t end, size_t) {
        uint32_t island = 0, run = 0; // triangles of an island mostly follow each other
        for (size_t t = begin; t < end; ++t) {
            if (!is_in_tile[t])
                continue;
            if (const uint32_t own = islands.of_triangle(t); own != island) {
                triangles[island] += std::exchange(run, 0);
                island = own;
            }
            ++run;
            if (!covers[island] && raster.covers_any_texel(t))
                covers[island] = true;
        }
        triangles[island] += run;
    });
    report.islands = report.uncovered_islands = report.uncovered_triangles = 0;
    for (size_t i = 0; i < islands.end(); ++i) {
        report.islands += triangles[i] > 0;
        report.uncovered_islands += triangles[i] > 0 && !covers[i];
        report.uncovered_triangles += covers[i] ? 0 : triangles[i].load();
    }
}

std::vector<uint32_t> islands_of_triangles(const Mesh& mesh)
{
    Islands islands(mesh, [&](uint32_t triangle) {
        const auto& [a, b, c] = mesh.triangles[triangle];
        return has_uv(mesh, a) && has_uv(mesh, b) && has_uv(mesh, c);
    });
    std::vector<uint32_t> numbers(mesh.triangles.size());
    parallel_blocks(numbers.size(), [&](size_t begin, size_t end, size_t) {
        for (size_t t = begin; t < end; ++t)
            numbers[t] = islands.of_triangle(t);
    });
    return numbers;
}

} // namespace vmlight
