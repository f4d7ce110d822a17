// SPDX-License-Identifier: Apache-2.0
#include <vmlight/uv/islands.h>

#include <vmlight/base/numbering.h>

#include <numeric>

namespace vmlight {
namespace {

/// Sets of numbers, each told by one of them. Source: R. Tarjan, "Efficiency of a Good But Not Linear Set Union
/// Algorithm", JACM 22(2), 1975; with paths halved.
class Sets
{
public:
    explicit Sets(size_t count)
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

struct Island
{
    int64_t triangles = 0;
    bool covers = false;
};

} // namespace

void count_islands(UvReport& report, const Mesh& mesh, const UvRaster& raster)
{
    Numbering<Imath::V2f> places(mesh.uvs.size());
    std::vector<uint32_t> place_of_vertex;
    for (const Imath::V2f& uv : mesh.uvs)
        place_of_vertex.push_back(places.number(uv + Imath::V2f(0))); // -0 becomes 0
    Sets sets(places.keys().size());
    std::vector<uint32_t> here;
    for (uint32_t t = 0; t < mesh.triangles.size(); ++t) {
        if (!raster.is_here(t))
            continue;
        here.push_back(t);
        for (int k = 1; k < 3; ++k)
            sets.join(place_of_vertex[mesh.triangles[t][0]], place_of_vertex[mesh.triangles[t][k]]);
    }
    std::vector<Island> islands(places.keys().size());
    for (uint32_t t : here) {
        Island& island = islands[sets.find(place_of_vertex[mesh.triangles[t][0]])];
        ++island.triangles;
        island.covers = island.covers || raster.covers_any(t);
    }
    report.islands = report.lost_islands = report.lost_triangles = 0;
    for (const Island& island : islands) {
        report.islands += island.triangles > 0;
        report.lost_islands += island.triangles > 0 && !island.covers;
        report.lost_triangles += island.covers ? 0 : island.triangles;
    }
}

} // namespace vmlight
