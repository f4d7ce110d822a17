// SPDX-License-Identifier: Apache-2.0
#include <vmlight/uvraster.h>

#include <algorithm>
#include <cmath>
#include <numeric>

namespace vmlight {
namespace {

constexpr int64_t kSubtexels = 256;
// Beyond two million texels the products of the edge tests would leave 64 bits.
constexpr double kFarthest = double(1 << 21) * kSubtexels;

int64_t floor_divide(int64_t a, int64_t b)
{
    return a >= 0 ? a / b : -((-a + b - 1) / b);
}

// No tile of the ten columns has it.
bool reaches_beyond(const Mesh& mesh, size_t triangle)
{
    const auto& corners = mesh.triangles[triangle];
    return std::any_of(corners.begin(), corners.end(), [&](uint32_t vertex) {
        const Imath::V2f& uv = mesh.uvs[vertex];
        return uv.x < -kUdimBorder || uv.x > 10 + kUdimBorder || uv.y < -kUdimBorder;
    });
}

} // namespace

// Rounded texture coordinates, y down. False if they are missing, not finite, or too far away.
bool UvRaster::corners(size_t triangle, std::array<Corner, 3>& dst) const
{
    for (int k = 0; k < 3; ++k) {
        const Imath::V2f& uv = m_mesh.uvs[m_mesh.triangles[triangle][k]];
        // Whole numbers come off a double that was a float without rounding.
        const double u = double(uv.x) - m_corner.x, v = double(uv.y) - m_corner.y;
        const double x = u * m_width * kSubtexels, y = (1.0 - v) * m_height * kSubtexels;
        if (!(std::abs(x) <= kFarthest && std::abs(y) <= kFarthest))
            return false;
        dst[k] = { std::llround(x), std::llround(y) };
    }
    return true;
}

template <class Visit> void UvRaster::each_tile(const std::array<Corner, 3>& c, Visit&& visit) const
{
    const auto span = [](int64_t a, int64_t b, int64_t d, int texels) {
        // Texels whose centre, at 256 i + 128, lies between the least and the greatest corner.
        const int64_t low = std::min({ a, b, d }), high = std::max({ a, b, d });
        const int64_t first = std::max<int64_t>(0, floor_divide(low - kSubtexels / 2 + kSubtexels - 1, kSubtexels));
        const int64_t last = std::min<int64_t>(texels - 1, floor_divide(high - kSubtexels / 2, kSubtexels));
        return std::pair<int64_t, int64_t>(first, last);
    };
    const auto [x0, x1] = span(c[0].x, c[1].x, c[2].x, m_width);
    const auto [y0, y1] = span(c[0].y, c[1].y, c[2].y, m_height);
    if (x0 > x1 || y0 > y1)
        return;
    for (int64_t ty = y0 / kTileSize; ty <= y1 / kTileSize; ++ty)
        for (int64_t tx = x0 / kTileSize; tx <= x1 / kTileSize; ++tx)
            visit(size_t(ty * tiles_across() + tx));
}

void UvRaster::count_outside(size_t triangle, const std::array<Corner, 3>& c)
{
    const int64_t w = m_width * kSubtexels, h = m_height * kSubtexels;
    const auto x = std::minmax({ c[0].x, c[1].x, c[2].x }), y = std::minmax({ c[0].y, c[1].y, c[2].y });
    const bool outside = x.first < 0 || x.second > w || y.first < 0 || y.second > h;
    m_report.outside += outside;
    m_report.elsewhere += outside && (x.second <= 0 || x.first >= w || y.second <= 0 || y.first >= h);
    m_report.beyond += outside && reaches_beyond(m_mesh, triangle);
}

// What corners() has none of.
void UvRaster::count_far(size_t triangle)
{
    const auto& corners = m_mesh.triangles[triangle];
    const bool finite = std::all_of(corners.begin(), corners.end(), [&](uint32_t vertex) {
        return std::isfinite(m_mesh.uvs[vertex].x) && std::isfinite(m_mesh.uvs[vertex].y);
    });
    ++(finite ? m_report.outside : m_report.without_uv);
    m_report.elsewhere += finite;
    m_report.beyond += finite && reaches_beyond(m_mesh, triangle);
}

UvRaster::UvRaster(const Mesh& mesh, int width, int height, int udim)
    : m_mesh(mesh)
    , m_width(width)
    , m_height(height)
    , m_corner(udim_corner(udim))
{
    m_first.assign(size_t(tiles_across()) * tiles_down() + 2, 0);
    std::vector<uint32_t> kept;
    std::array<Corner, 3> c;
    m_report.triangles = int64_t(mesh.triangles.size());
    for (uint32_t t = 0; t < mesh.triangles.size(); ++t) {
        if (!corners(t, c)) {
            count_far(t);
            continue;
        }
        count_outside(t, c);
        // y points down here, so that a positive area means clockwise in (u, v).
        const int64_t area = (c[1].x - c[0].x) * (c[2].y - c[0].y) - (c[2].x - c[0].x) * (c[1].y - c[0].y);
        const double area_3d = triangle_area_normal(mesh, mesh.triangles[t]).length();
        m_report.mirrored += area > 0;
        m_report.degenerate_uv += area == 0;
        m_report.degenerate_3d += !(area_3d > 0);
        if (area == 0 || !(area_3d > 0))
            continue;
        kept.push_back(t);
        each_tile(c, [&](size_t tile) { ++m_first[tile + 2]; });
    }
    std::partial_sum(m_first.begin(), m_first.end(), m_first.begin());
    m_binned.resize(m_first.back());
    for (uint32_t t : kept) {
        corners(t, c);
        each_tile(c, [&](size_t tile) { m_binned[m_first[tile + 1]++] = t; });
    }
    m_first.pop_back();
}

void UvRaster::cover(int tile, TileCover& dst) const
{
    dst.triangle.fill(TileCover::kNone);
    dst.covered = dst.overlapping = 0;
    std::array<bool, kTileSize * kTileSize> shared {};
    const int64_t tile_x = int64_t(tile % tiles_across()) * kTileSize;
    const int64_t tile_y = int64_t(tile / tiles_across()) * kTileSize;
    const int64_t end_x = std::min<int64_t>(tile_x + kTileSize, m_width);
    const int64_t end_y = std::min<int64_t>(tile_y + kTileSize, m_height);

    for (size_t i = m_first[tile]; i < m_first[tile + 1]; ++i) {
        const uint32_t t = m_binned[i];
        std::array<Corner, 3> c;
        corners(t, c);
        const int64_t area = (c[1].x - c[0].x) * (c[2].y - c[0].y) - (c[2].x - c[0].x) * (c[1].y - c[0].y);
        const bool turned = area < 0;
        if (turned)
            std::swap(c[1], c[2]);

        // Edge k runs from corner k+1 to corner k+2: its function is twice the area that weighs corner k, positive
        // inside. A centre on the edge belongs to the triangle if the edge is a left one (it runs up) or a top one.
        std::array<int64_t, 3> step_x, step_y, row;
        std::array<int64_t, 3> least;
        const auto bounds = std::minmax({ c[0].y, c[1].y, c[2].y });
        const auto bounds_x = std::minmax({ c[0].x, c[1].x, c[2].x });
        const int64_t y0 = std::max(tile_y, floor_divide(bounds.first - kSubtexels / 2, kSubtexels));
        const int64_t y1 = std::min(end_y, floor_divide(bounds.second, kSubtexels) + 1);
        const int64_t x0 = std::max(tile_x, floor_divide(bounds_x.first - kSubtexels / 2, kSubtexels));
        const int64_t x1 = std::min(end_x, floor_divide(bounds_x.second, kSubtexels) + 1);
        for (int k = 0; k < 3; ++k) {
            const Corner &a = c[(k + 1) % 3], &b = c[(k + 2) % 3];
            const int64_t dx = b.x - a.x, dy = b.y - a.y;
            step_x[k] = -dy * kSubtexels;
            step_y[k] = dx * kSubtexels;
            row[k] = dx * (y0 * kSubtexels + kSubtexels / 2 - a.y) - dy * (x0 * kSubtexels + kSubtexels / 2 - a.x);
            least[k] = dy < 0 || (dy == 0 && dx > 0) ? 0 : 1;
        }
        const double per_area = 1.0 / double(std::abs(area));
        for (int64_t y = y0; y < y1; ++y) {
            std::array<int64_t, 3> e = row;
            for (int64_t x = x0; x < x1; ++x) {
                if (e[0] >= least[0] && e[1] >= least[1] && e[2] >= least[2]) {
                    const size_t texel = size_t((y - tile_y) * kTileSize + (x - tile_x));
                    if (dst.triangle[texel] == TileCover::kNone) {
                        dst.triangle[texel] = t;
                        dst.weight1[texel] = float(double(e[turned ? 2 : 1]) * per_area);
                        dst.weight2[texel] = float(double(e[turned ? 1 : 2]) * per_area);
                        ++dst.covered;
                    } else if (!shared[texel]) {
                        shared[texel] = true;
                        ++dst.overlapping;
                    }
                }
                for (int k = 0; k < 3; ++k)
                    e[k] += step_x[k];
            }
            for (int k = 0; k < 3; ++k)
                row[k] += step_y[k];
        }
    }
}

} // namespace vmlight
