// SPDX-License-Identifier: Apache-2.0
#include <vmlight/uv/islands.h>

#include <vmlight/base/unique_index.h>

#include <numeric>

namespace vmlight {
namespace {

/// Disjoint sets of numbers, each identified by one of them. Source: R. Tarjan, "Efficiency of a Good But Not Linear
/// Set Union Algorithm", JACM 22(2), 1975; with path halving.
class DisjointSets
{
public:
    explicit DisjointSets(size_t count)
        : m_parent(count)
    {
        std::iota(m_parent.begin(), m_parent.end(), 0u);
    }
    uint32_t find(uint32_t i)
    {
        while (m_parent[i] != i)
            i = m_parent[i] = m_parent[m_parent[i]];
        return i;
    }
    void join(uint32_t a, uint32_t b) { m_parent[find(a)] = find(b); }

private:
    std::vector<uint32_t> m_parent;
};

// Vertices with the same texture coordinates have the same number.
std::vector<uint32_t> number_points(const Mesh& mesh, size_t& count)
{
    std::vector<uint32_t> first;
    const auto point = [&](size_t vertex) { return mesh.uvs[vertex] + Imath::V2f(0); }; // -0 becomes 0
    std::vector<uint32_t> point_of_vertex = number_alike(mesh.uvs.size(), point, first);
    count = first.size();
    return point_of_vertex;
}

struct Island
{
    int64_t triangles = 0;
    bool covers = false;
};

} // namespace

void count_islands(UvReport& report, const Mesh& mesh, const UvRaster& raster)
{
    size_t points = 0;
    const std::vector<uint32_t> point_of_vertex = number_points(mesh, points);
    DisjointSets sets(points);
    std::vector<uint32_t> in_tile;
    for (uint32_t t = 0; t < mesh.triangles.size(); ++t) {
        if (!raster.is_in_tile(t))
            continue;
        in_tile.push_back(t);
        for (int k = 1; k < 3; ++k)
            sets.join(point_of_vertex[mesh.triangles[t][0]], point_of_vertex[mesh.triangles[t][k]]);
    }
    std::vector<Island> islands(points);
    for (uint32_t t : in_tile) {
        Island& island = islands[sets.find(point_of_vertex[mesh.triangles[t][0]])];
        ++island.triangles;
        island.covers = island.covers || raster.covers_any_texel(t);
    }
    report.islands = report.uncovered_islands = report.uncovered_triangles = 0;
    for (const Island& island : islands) {
        report.islands += island.triangles > 0;
        report.uncovered_islands += island.triangles > 0 && !island.covers;
        report.uncovered_triangles += island.covers ? 0 : island.triangles;
    }
}

std::vector<uint32_t> islands_of_triangles(const Mesh& mesh)
{
    size_t points = 0;
    const std::vector<uint32_t> point_of_vertex = number_points(mesh, points);
    DisjointSets sets(points);
    for (const auto& [a, b, c] : mesh.triangles)
        if (has_uv(mesh, a) && has_uv(mesh, b) && has_uv(mesh, c)) {
            sets.join(point_of_vertex[a], point_of_vertex[b]);
            sets.join(point_of_vertex[a], point_of_vertex[c]);
        }
    std::vector<uint32_t> islands;
    islands.reserve(mesh.triangles.size());
    for (const auto& triangle : mesh.triangles)
        islands.push_back(sets.find(point_of_vertex[triangle[0]]));
    return islands;
}

} // namespace vmlight
