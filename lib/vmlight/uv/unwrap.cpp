// SPDX-License-Identifier: Apache-2.0
#include <vmlight/uv/unwrap.h>

#include <vmlight/base/format.h>
#include <vmlight/base/parallel.h>
#include <vmlight/base/stopwatch.h>
#include <vmlight/base/text_format.h>
#include <vmlight/base/unique_index.h>
#include <vmlight/uv/unwrap_chart.h>
#include <vmlight/uv/unwrap_grow.h>
#include <vmlight/uv/unwrap_merge.h>
#include <vmlight/uv/unwrap_pack.h>

#include <algorithm>
#include <cmath>
#include <numeric>

namespace vmlight {

using Imath::V2d;
using Imath::V2f;

namespace {

constexpr double kMostChartStretch = 1.3;
// UVs are whole numbers of these steps: exact in float, all over [0, 1].
constexpr double kSteps = 1 << 24;

// Charts that are laid flat: those that cannot be are divided until they can.
std::vector<UnwrapChart> flat_charts(const UnwrapSurface& surface, JoinedEdges& joined, std::vector<uint32_t>& place,
                                     int nthreads)
{
    std::vector<std::vector<uint32_t>> pieces = grow_charts(surface, joined);
    std::vector<UnwrapChart> done;
    while (!pieces.empty()) {
        std::vector<UnwrapChart> charts(pieces.size());
        std::vector<std::array<std::vector<uint32_t>, 2>> parts(pieces.size());
        parallel_items(int64_t(pieces.size()), nthreads, [&](int64_t item, int) {
            const size_t i = size_t(item);
            build_chart(charts[i], surface, std::move(pieces[i]), joined, place);
            if (!flatten_chart(charts[i], surface, kMostChartStretch))
                parts[i] = split_chart(charts[i], surface, joined, place);
        });
        pieces.clear();
        for (size_t i = 0; i < charts.size(); ++i) {
            if (parts[i][0].empty())
                done.push_back(std::move(charts[i]));
            for (std::vector<uint32_t>& part : parts[i])
                if (!part.empty())
                    pieces.push_back(std::move(part));
        }
    }
    return done;
}

// The gap between charts in units of length of the surface, in an atlas where charts and gaps take most of the map.
double expected_gap(const std::vector<UnwrapChart>& charts, const UnwrapParams& params)
{
    constexpr double kTaken = 0.7;
    double low = 0, high = 1; // the surface has a size of 1
    for (int step = 0; step < 40; ++step) {
        const double gap = (low + high) / 2, density = unwrap_gap(params) / gap;
        double texels = 0;
        for (const UnwrapChart& chart : charts)
            texels += std::pow((std::sqrt(chart.area) + gap) * density, 2);
        (texels < kTaken * params.width * params.height ? high : low) = gap;
    }
    return high;
}

// Charts that are joined have fewer margins; but a few large ones may pack better as they are.
bool join_and_pack(std::vector<UnwrapChart>& charts, const UnwrapSurface& surface, JoinedEdges& joined,
                   std::vector<uint32_t>& place, const UnwrapParams& params, double& density)
{
    constexpr size_t kFew = 256;
    std::vector<UnwrapChart> apart;
    if (charts.size() <= kFew)
        apart = charts;
    merge_charts(charts, surface, joined, place, expected_gap(charts, params), params.nthreads);
    const bool fits = pack_charts(charts, params, density);
    double density_apart = 0;
    if (apart.size() == charts.size() || apart.empty() || !pack_charts(apart, params, density_apart))
        return fits;
    if (!fits || density_apart > density) {
        charts = std::move(apart);
        density = density_apart;
    }
    return true;
}

// Gives each corner of a mesh its UV.
class AtlasWriter
{
public:
    explicit AtlasWriter(const Mesh& mesh)
        : m_mesh(mesh)
        , m_uvs(3 * mesh.triangles.size(), V2f(0))
        , m_is_done(mesh.triangles.size(), 0)
    {
    }

    void add(const UnwrapChart& chart, const UnwrapParams& params, UnwrapReport& report)
    {
        const auto step = [](double share) { return std::clamp(std::round(share * kSteps), 0.0, kSteps); };
        for (size_t i = 0; i < chart.triangles.size(); ++i) {
            std::array<V2d, 3> steps;
            for (int k = 0; k < 3; ++k) {
                const V2d& texels = chart.uvs[chart.corners[i][k]];
                steps[k] = { step(texels.x / params.width), step(texels.y / params.height) };
                m_uvs[3 * chart.triangles[i] + k] = V2f(steps[k] / kSteps);
            }
            m_is_done[chart.triangles[i]] = 1;
            const double doubled = (steps[1] - steps[0]).cross(steps[2] - steps[0]); // exact: below 2^50
            report.too_thin += doubled <= 0;
            report.coverage += std::max(0.0, doubled) / (2 * kSteps * kSteps);
        }
    }

    // A triangle without area is a point: one of a neighbour, so that it adds no vertices where it need not.
    void drop_the_rest(UnwrapReport& report)
    {
        std::vector<uint32_t> corner_at(m_mesh.positions.size(), UnwrapSurface::kNone);
        for (uint32_t corner = 0; corner < m_uvs.size(); ++corner)
            if (m_is_done[corner / 3])
                corner_at[m_mesh.triangles[corner / 3][corner % 3]] = corner;
        for (uint32_t t = 0; t < m_mesh.triangles.size(); ++t) {
            if (m_is_done[t])
                continue;
            ++report.without_area;
            for (uint32_t vertex : m_mesh.triangles[t])
                if (corner_at[vertex] != UnwrapSurface::kNone)
                    std::fill_n(m_uvs.begin() + 3 * t, 3, m_uvs[corner_at[vertex]]);
        }
    }

    void write(Mesh& dst) const
    {
        struct Key
        {
            uint32_t vertex;
            V2f uv;
        };
        UniqueIndex<Key> keys(m_uvs.size());
        std::vector<std::array<uint32_t, 3>> triangles(m_mesh.triangles.size());
        for (size_t corner = 0; corner < m_uvs.size(); ++corner)
            triangles[corner / 3][corner % 3]
                = keys.index_of({ m_mesh.triangles[corner / 3][corner % 3], m_uvs[corner] });
        std::vector<Imath::V3d> positions;
        std::vector<Imath::V3f> normals;
        std::vector<V2f> uvs;
        for (const Key& key : keys.keys()) {
            positions.push_back(m_mesh.positions[key.vertex]);
            normals.push_back(m_mesh.normals[key.vertex]);
            uvs.push_back(key.uv);
        }
        dst.positions = std::move(positions);
        dst.normals = std::move(normals);
        dst.uvs = std::move(uvs);
        dst.triangles = std::move(triangles);
    }

private:
    const Mesh& m_mesh;
    std::vector<V2f> m_uvs; // of each corner
    std::vector<char> m_is_done;
};

} // namespace

bool unwrap_mesh(Mesh& mesh, const UnwrapParams& params, UnwrapReport* report, std::string& error)
{
    const Stopwatch timer;
    if (!check_mesh(mesh, error))
        return false;
    const UnwrapSurface surface(mesh);
    JoinedEdges joined(3 * mesh.triangles.size(), 0);
    std::vector<uint32_t> place(mesh.triangles.size(), 0);
    std::vector<UnwrapChart> charts = flat_charts(surface, joined, place, params.nthreads);
    const std::string& name = mesh.path.empty() ? mesh.name : mesh.path;
    if (charts.empty()) {
        error = format("\"{}\": no triangle has an area: there is nothing to unwrap", name);
        return false;
    }
    UnwrapReport counts;
    const bool fits = join_and_pack(charts, surface, joined, place, params, counts.density);
    counts.charts = int64_t(charts.size());
    double area = 0, stretch = 0;
    for (const UnwrapChart& chart : charts) {
        area += chart.area;
        stretch += chart.area * chart.stretch * chart.stretch;
    }
    counts.stretch = std::sqrt(stretch / area);
    if (!fits) {
        error = format("\"{}\": {} do not fit into {}x{} texels with a margin of {}: choose a larger resolution or a "
                       "smaller margin",
                       name, count_text(counts.charts, "chart", "charts"), params.width, params.height,
                       unwrap_gap(params));
        return false;
    }
    counts.density /= surface.unit();
    AtlasWriter writer(mesh);
    for (const UnwrapChart& chart : charts)
        writer.add(chart, params, counts);
    writer.drop_the_rest(counts);
    writer.write(mesh);
    counts.seconds = timer();
    if (report)
        *report = counts;
    return true;
}

} // namespace vmlight
