// SPDX-License-Identifier: Apache-2.0
#include <vmlight/vismap/seam_links.h>

#include <vmlight/base/number_alike.h>
#include <vmlight/uv/islands.h>
#include <vmlight/uv/udim.h>
#include <vmlight/vismap/neighbour_weights.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <tuple>

namespace vmlight {

using Imath::V2d;
using Imath::V2f;
using Imath::V3d;
using Imath::V3f;

namespace {

// Of a cell from a seam, in texels: the outermost texels of an island are up to one from its edge.
constexpr int kFarthest = NeighbourWindow::kHalo + 1;
// Links near a tile. More are of islands smaller than a texel, which have nothing to share.
constexpr size_t kMostLinks = size_t(kTileSize) * kTileSize;
// Between the normals of both sides, at the ends of a seam. A crease shares nothing, but would make patches beside it
// seem alike.
constexpr float kSmooth = 0.9f;
// Texels on the other side for one on this, by area. With fewer, one texel would count several times.
constexpr double kLeastDensity = 0.5;

struct SeamEdge
{
    uint32_t low, high; // numbers of its positions
    uint32_t triangle, corner; // it goes from this corner to the next
};

// Vertices at the same position have the same number.
std::vector<uint32_t> number_positions(const Mesh& mesh, std::vector<bool>& has_seam)
{
    std::vector<uint32_t> first; // vertex of each
    const auto position = [&](size_t vertex) { return mesh.positions[vertex] + V3d(0); }; // -0 becomes 0
    std::vector<uint32_t> numbers = number_alike(mesh.positions.size(), position, first);
    has_seam.assign(first.size(), false);
    for (size_t v = 0; v < numbers.size(); ++v)
        if (const uint32_t other = first[numbers[v]]; other != v && mesh.uvs[v] != mesh.uvs[other])
            has_seam[numbers[v]] = true;
    return numbers;
}

// Edges at whose ends uvs change, those with the same positions one after the other.
std::vector<SeamEdge> seam_edges(const Mesh& mesh, const UvRaster& raster)
{
    std::vector<bool> has_seam;
    const std::vector<uint32_t> numbers = number_positions(mesh, has_seam);
    std::vector<SeamEdge> edges;
    for (uint32_t t = 0; t < mesh.triangles.size(); ++t)
        for (uint32_t k = 0; k < 3; ++k) {
            const uint32_t a = numbers[mesh.triangles[t][k]], b = numbers[mesh.triangles[t][(k + 1) % 3]];
            if (a != b && (has_seam[a] || has_seam[b]) && raster.is_in_tile(t))
                edges.push_back({ std::min(a, b), std::max(a, b), t, k });
        }
    std::sort(edges.begin(), edges.end(), [](const SeamEdge& a, const SeamEdge& b) {
        return std::tie(a.low, a.high, a.triangle, a.corner) < std::tie(b.low, b.high, b.triangle, b.corner);
    });
    return edges;
}

// A triangle and one of its edges, from `from` to `to`.
struct SideOfSeam
{
    V3d from, to, apex;
    V2d from_texel, to_texel, apex_texel;
    V3f from_normal, to_normal;

    // Of the apex: along the edge, in its length, and the distance from it.
    double along() const { return (apex - from).dot(to - from) / (to - from).length2(); }
    double height() const { return (to - from).cross(apex - from).length() / (to - from).length(); }
    V3d facet() const { return (to - from).cross(apex - from).normalized(); }
};

double cross(V2d a, V2d b)
{
    return a.x * b.y - a.y * b.x;
}

} // namespace

SeamLinks::SeamLinks(const Mesh& mesh, const UvRaster& raster, int width, int height, int udim)
    : m_tiles_across(raster.tiles_across())
    , m_width(width)
    , m_height(height)
    , m_islands(islands_of_triangles(mesh))
{
    const V2d corner(udim_corner(udim));
    const auto side_of = [&](const SeamEdge& edge, bool reversed) {
        const auto& vertices = mesh.triangles[edge.triangle];
        const uint32_t a = vertices[edge.corner], b = vertices[(edge.corner + 1) % 3];
        const uint32_t ends[] = { reversed ? b : a, reversed ? a : b, vertices[(edge.corner + 2) % 3] };
        const auto texel = [&](uint32_t v) {
            const V2d uv = V2d(mesh.uvs[v]) - corner;
            return V2d(uv.x * width, (1 - uv.y) * height);
        };
        return SideOfSeam { mesh.positions[ends[0]], mesh.positions[ends[1]], mesh.positions[ends[2]],
                            texel(ends[0]),          texel(ends[1]),          texel(ends[2]),
                            mesh.normals[ends[0]],   mesh.normals[ends[1]] };
    };
    const auto add = [&](const SideOfSeam& near, const SideOfSeam& far, uint32_t island) {
        const V2d edge = near.to_texel - near.from_texel, apex = near.apex_texel - near.from_texel;
        const double area = cross(edge, apex);
        // A step of one texel is so much along the edge, in its length, and so much away from the apex.
        const auto source = [&](V2d step) {
            const double towards = cross(edge, step) / area;
            const double along = cross(step, apex) / area + towards * near.along();
            const double beyond = -towards * near.height() / far.height();
            return (far.to_texel - far.from_texel) * (along - beyond * far.along())
                + (far.apex_texel - far.from_texel) * beyond;
        };
        const V2d across = source(V2d(1, 0)), down = source(V2d(0, 1));
        const double density = std::abs(cross(across, down));
        if (!std::isfinite(density) || density < kLeastDensity)
            return;
        m_links.push_back({ V2f(near.from_texel), V2f(near.to_texel), V2f(far.from_texel), V2f(across), V2f(down),
                            area > 0 ? 1.0f : -1.0f, island });
    };
    const std::vector<SeamEdge> edges = seam_edges(mesh, raster);
    for (size_t first = 0, last = 0; first < edges.size(); first = last) {
        while (last < edges.size() && edges[last].low == edges[first].low && edges[last].high == edges[first].high)
            ++last;
        if (last - first != 2)
            continue;
        const SeamEdge &a = edges[first], &b = edges[first + 1];
        const SideOfSeam left = side_of(a, false);
        SideOfSeam right = side_of(b, false);
        if (right.from != left.from)
            right = side_of(b, true);
        if (left.from_texel == right.from_texel && left.to_texel == right.to_texel)
            continue;
        if (left.from_normal.dot(right.from_normal) < kSmooth || left.to_normal.dot(right.to_normal) < kSmooth
            || -left.facet().dot(right.facet()) < double(kSmooth))
            continue;
        add(left, right, island(a.triangle));
        add(right, left, island(b.triangle));
    }
    bin(raster.tiles_across(), raster.tiles_down());
}

void SeamLinks::bin(int across, int down)
{
    const auto each_tile = [&](const Link& link, auto&& visit) {
        constexpr float kReach = float(kFarthest + NeighbourWindow::kHalo);
        const auto tile = [&](float texel, int tiles) {
            return int(std::clamp(std::floor(texel / kTileSize), -1.0f, float(tiles)));
        };
        const int left = std::max(0, tile(std::min(link.first.x, link.second.x) - kReach, across));
        const int right = std::min(across - 1, tile(std::max(link.first.x, link.second.x) + kReach, across));
        const int top = std::max(0, tile(std::min(link.first.y, link.second.y) - kReach, down));
        const int bottom = std::min(down - 1, tile(std::max(link.first.y, link.second.y) + kReach, down));
        for (int y = top; y <= bottom; ++y)
            for (int x = left; x <= right; ++x)
                visit(size_t(y) * size_t(across) + size_t(x));
    };
    m_first.assign(size_t(across) * size_t(down) + 1, 0);
    for (const Link& link : m_links)
        each_tile(link, [&](size_t tile) { ++m_first[tile + 1]; });
    for (size_t tile = 0; tile + 1 < m_first.size(); ++tile)
        m_first[tile + 1] += m_first[tile];
    m_binned.resize(m_first.back());
    std::vector<size_t> next(m_first.begin(), m_first.end() - 1);
    for (uint32_t k = 0; k < m_links.size(); ++k)
        each_tile(m_links[k], [&](size_t tile) { m_binned[next[tile]++] = k; });
}

size_t SeamLinks::bytes() const
{
    return m_islands.size() * sizeof(uint32_t) + m_links.size() * sizeof(Link) + m_first.size() * sizeof(size_t)
        + m_binned.size() * sizeof(uint32_t);
}

void SeamLinks::find(OIIO::ROI roi, std::vector<SeamCell>& dst) const
{
    constexpr int kHalo = NeighbourWindow::kHalo;
    dst.clear();
    const auto visit = [&](const Link& link) {
        const V2f low(std::min(link.first.x, link.second.x), std::min(link.first.y, link.second.y));
        const V2f high(std::max(link.first.x, link.second.x), std::max(link.first.y, link.second.y));
        const auto cell
            = [](float texel, int from, int to) { return int(std::clamp(std::floor(texel), float(from), float(to))); };
        const int left = cell(low.x - kFarthest, roi.xbegin - kHalo, roi.xend + kHalo);
        const int right = cell(high.x + kFarthest + 1, roi.xbegin - kHalo, roi.xend + kHalo);
        const int top = cell(low.y - kFarthest, roi.ybegin - kHalo, roi.yend + kHalo);
        const int bottom = cell(high.y + kFarthest + 1, roi.ybegin - kHalo, roi.yend + kHalo);
        const V2f edge = link.second - link.first;
        for (int y = top; y < bottom; ++y)
            for (int x = left; x < right; ++x) {
                const V2f step = V2f(float(x) + 0.5f, float(y) + 0.5f) - link.first;
                if ((edge.x * step.y - edge.y * step.x) * link.side > 0)
                    continue;
                const float along = std::clamp(edge.dot(step) / edge.length2(), 0.0f, 1.0f);
                const float distance = (step - edge * along).length();
                if (!(distance <= kFarthest))
                    continue;
                const V2f source = link.origin + link.across * step.x + link.down * step.y;
                if (!(source.x >= 0 && source.y >= 0 && source.x < float(m_width) && source.y < float(m_height)))
                    continue;
                const SeamCell found { link.island, x, y, distance, int(source.x), int(source.y) };
                // Islands that lie side by side as on the surface.
                if (found.source_x != x || found.source_y != y)
                    dst.push_back(found);
            }
    };
    for (int y = roi.ybegin / kTileSize; y <= (roi.yend - 1) / kTileSize; ++y)
        for (int x = roi.xbegin / kTileSize; x <= std::min(m_tiles_across - 1, (roi.xend - 1) / kTileSize); ++x) {
            const size_t tile = size_t(y) * size_t(m_tiles_across) + size_t(x);
            if (tile + 1 < m_first.size() && m_first[tile + 1] - m_first[tile] <= kMostLinks)
                for (size_t k = m_first[tile]; k < m_first[tile + 1]; ++k)
                    visit(m_links[m_binned[k]]);
        }
    const auto key = [](const SeamCell& cell) {
        return std::tie(cell.island, cell.y, cell.x, cell.distance, cell.source_y, cell.source_x);
    };
    std::sort(dst.begin(), dst.end(), [&](const SeamCell& a, const SeamCell& b) { return key(a) < key(b); });
}

} // namespace vmlight
