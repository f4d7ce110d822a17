// SPDX-License-Identifier: Apache-2.0
#include <vmlight/uv/raster.h>

#include <vmlight/base/parallel_blocks.h>
#include <vmlight/uv/raster_edges.h>

#include <algorithm>
#include <cmath>
#include <utility>

namespace vmlight {
namespace {

// Beyond two million texels the products of the edge tests would overflow 64 bits.
constexpr double kFarthest = double(1 << 21) * kSubtexels;

int64_t floor_divide(int64_t a, int64_t b)
{
    return a >= 0 ? a / b : -((-a + b - 1) / b);
}

// Is a corner outside every UDIM tile?
bool reaches_beyond_udims(const Mesh& mesh, size_t triangle)
{
    const auto& corners = mesh.triangles[triangle];
    return std::any_of(corners.begin(), corners.end(), [&](uint32_t vertex) {
        const Imath::V2f& uv = mesh.uvs[vertex];
        return uv.x < -kUdimBorder || uv.x > 10 + kUdimBorder || uv.y < -kUdimBorder;
    });
}

} // namespace

// A corner's texture coordinates in subtexels, y down.
Imath::V2d UvRaster::corner_position(size_t triangle, int corner) const
{
    const Imath::V2f& uv = m_mesh.uvs[m_mesh.triangles[triangle][corner]];
    // Exact: whole numbers subtracted from floats in double.
    const double u = double(uv.x) - m_corner.x, v = double(uv.y) - m_corner.y;
    return { u * m_width * kSubtexels, (1.0 - v) * m_height * kSubtexels };
}

Imath::V2d UvRaster::size() const
{
    return Imath::V2d(m_width, m_height) * double(kSubtexels);
}

// Texture coordinates rounded to subtexels. False if they are missing, not finite, or too far away.
bool UvRaster::corners(size_t triangle, std::array<UvCorner, 3>& dst) const
{
    for (int k = 0; k < 3; ++k) {
        const Imath::V2d position = corner_position(triangle, k);
        if (!(std::abs(position.x) <= kFarthest && std::abs(position.y) <= kFarthest))
            return false;
        dst[k] = { rounded_subtexel(position.x), rounded_subtexel(position.y) };
    }
    return true;
}

template <class Visit> void UvRaster::for_each_tile(const std::array<UvCorner, 3>& c, Visit&& visit) const
{
    const auto span = [](int64_t a, int64_t b, int64_t d, int texels) {
        // Texels whose centre, at 256 i + 128, is between the lowest and the highest corner.
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

// Bounds of a triangle, rounded as in corners(), but of any size. Not finite if a corner is not.
struct UvRaster::Bounds
{
    Imath::V2d low, high;

    bool is_finite() const { return std::isfinite(low.x + low.y + high.x + high.y); }
    bool reaches_out(const Imath::V2d& size) const
    {
        return low.x < 0 || low.y < 0 || high.x > size.x || high.y > size.y;
    }
    bool is_fully_outside(const Imath::V2d& size) const
    {
        return reaches_out(size) && (high.x <= 0 || high.y <= 0 || low.x >= size.x || low.y >= size.y);
    }
};

UvRaster::Bounds UvRaster::bounds_of(size_t triangle) const
{
    std::array<double, 3> x, y;
    for (int k = 0; k < 3; ++k) {
        const Imath::V2d position = corner_position(triangle, k);
        x[k] = rounded(position.x), y[k] = rounded(position.y);
        if (!std::isfinite(position.x + position.y))
            return { position, position };
    }
    return { { std::min({ x[0], x[1], x[2] }), std::min({ y[0], y[1], y[2] }) },
             { std::max({ x[0], x[1], x[2] }), std::max({ y[0], y[1], y[2] }) } };
}

void UvRaster::count_outside(size_t triangle, UvReport& report) const
{
    const Bounds bounds = bounds_of(triangle);
    const bool finite = bounds.is_finite(), outside = finite && bounds.reaches_out(size());
    report.without_uv += !finite;
    report.outside += outside;
    report.fully_outside += finite && bounds.is_fully_outside(size());
    report.beyond_udims += outside && reaches_beyond_udims(m_mesh, triangle);
}

// As nearly all are: no other bounds need be looked at.
bool UvRaster::lies_inside(const std::array<UvCorner, 3>& c) const
{
    return std::all_of(c.begin(), c.end(), [&](const UvCorner& corner) {
        return corner.x >= 0 && corner.y >= 0 && corner.x <= m_width * kSubtexels && corner.y <= m_height * kSubtexels;
    });
}

bool UvRaster::is_in_tile(size_t triangle) const
{
    std::array<UvCorner, 3> c;
    if (!corners(triangle, c) || !lies_inside(c)) {
        const Bounds bounds = bounds_of(triangle);
        if (!bounds.is_finite() || bounds.is_fully_outside(size()))
            return false;
    }
    return triangle_area_normal(m_mesh, m_mesh.triangles[triangle]).length() > 0;
}

bool UvRaster::covers_any_texel(size_t triangle) const
{
    std::array<UvCorner, 3> c;
    if (!corners(triangle, c) || doubled_area(c) == 0)
        return false;
    const UvEdges edges(c);
    const auto bounds = std::minmax({ c[0].y, c[1].y, c[2].y });
    const int64_t y0 = std::max<int64_t>(0, floor_divide(bounds.first - kSubtexels / 2, kSubtexels));
    const int64_t y1 = std::min<int64_t>(m_height, floor_divide(bounds.second, kSubtexels) + 1);
    for (int64_t y = y0; y < y1; ++y) {
        // The texels of this row on the inner side of all three edges.
        const std::array<int64_t, 3> e = edges.at(0, y);
        int64_t first = 0, last = m_width - 1;
        for (int k = 0; k < 3; ++k) {
            const int64_t lacking = edges.least[k] - e[k], step = edges.step_x[k];
            if (step > 0)
                first = std::max(first, -floor_divide(-lacking, step));
            else if (step < 0)
                last = std::min(last, floor_divide(-lacking, -step));
            else if (lacking > 0)
                last = -1;
        }
        if (first <= last)
            return true;
    }
    return false;
}

/// Consecutive triangles, which one thread sorts into tiles.
struct UvRaster::Portion
{
    size_t begin, end; // triangles
    UvReport report;
    std::vector<uint32_t> kept; // those with area
    std::vector<size_t> tiles; // of each tile: how many triangles, then the place of the next
};

void UvRaster::sort(Portion& portion) const
{
    std::array<UvCorner, 3> c;
    UvReport& report = portion.report;
    portion.tiles.assign(size_t(tiles_across()) * size_t(tiles_down()), 0);
    for (size_t t = portion.begin; t < portion.end; ++t) {
        const bool is_near = corners(t, c);
        if (!is_near || !lies_inside(c))
            count_outside(t, report);
        if (!is_near)
            continue;
        const int64_t area = doubled_area(c);
        const double area_3d = triangle_area_normal(m_mesh, m_mesh.triangles[t]).length();
        report.mirrored += area > 0;
        report.degenerate_uv += area == 0;
        report.degenerate_3d += !(area_3d > 0);
        if (area == 0 || !(area_3d > 0))
            continue;
        portion.kept.push_back(uint32_t(t));
        for_each_tile(c, [&](size_t tile) { ++portion.tiles[tile]; });
    }
}

UvRaster::UvRaster(const Mesh& mesh, int width, int height, int udim)
    : m_mesh(mesh)
    , m_width(width)
    , m_height(height)
    , m_corner(udim_corner(udim))
{
    // Few, as each counts all tiles.
    const size_t count = mesh.triangles.size();
    std::vector<Portion> portions(count > kElementsOfBlock ? size_t(std::min(worker_count(0), 16)) : 1);
    for (size_t i = 0; i < portions.size(); ++i)
        portions[i] = { count * i / portions.size(), count * (i + 1) / portions.size(), {}, {}, {} };
    const auto for_each_portion = [&](auto&& work) {
        parallel_items(int64_t(portions.size()), portions.size() > 1 ? 0 : 1,
                       [&](int64_t i, int) { work(portions[size_t(i)]); });
    };
    for_each_portion([&](Portion& portion) { sort(portion); });
    size_t sum = 0;
    for (size_t tile = 0; tile < portions[0].tiles.size(); ++tile) {
        m_first.push_back(sum);
        for (Portion& portion : portions)
            sum += std::exchange(portion.tiles[tile], sum);
    }
    m_first.push_back(sum);
    m_binned.resize(sum);
    for_each_portion([&](Portion& portion) {
        std::array<UvCorner, 3> c;
        for (const uint32_t t : portion.kept) {
            corners(t, c);
            for_each_tile(c, [&](size_t tile) { m_binned[portion.tiles[tile]++] = t; });
        }
    });
    m_report.triangles = int64_t(count);
    for (const Portion& portion : portions)
        for (const auto number :
             { &UvReport::without_uv, &UvReport::outside, &UvReport::fully_outside, &UvReport::beyond_udims,
               &UvReport::degenerate_uv, &UvReport::degenerate_3d, &UvReport::mirrored })
            m_report.*number += portion.report.*number;
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
        std::array<UvCorner, 3> c;
        corners(t, c);
        const UvEdges edges(c);
        const bool flipped = edges.flipped;
        const auto bounds = std::minmax({ c[0].y, c[1].y, c[2].y });
        const auto bounds_x = std::minmax({ c[0].x, c[1].x, c[2].x });
        const int64_t y0 = std::max(tile_y, floor_divide(bounds.first - kSubtexels / 2, kSubtexels));
        const int64_t y1 = std::min(end_y, floor_divide(bounds.second, kSubtexels) + 1);
        const int64_t x0 = std::max(tile_x, floor_divide(bounds_x.first - kSubtexels / 2, kSubtexels));
        const int64_t x1 = std::min(end_x, floor_divide(bounds_x.second, kSubtexels) + 1);
        std::array<int64_t, 3> row = edges.at(x0, y0);
        const auto &least = edges.least, &step_x = edges.step_x, &step_y = edges.step_y;
        const double per_area = 1.0 / double(std::abs(doubled_area(c)));
        for (int64_t y = y0; y < y1; ++y) {
            std::array<int64_t, 3> e = row;
            for (int64_t x = x0; x < x1; ++x) {
                if (e[0] >= least[0] && e[1] >= least[1] && e[2] >= least[2]) {
                    const size_t texel = size_t((y - tile_y) * kTileSize + (x - tile_x));
                    if (dst.triangle[texel] == TileCover::kNone) {
                        dst.triangle[texel] = t;
                        dst.weight1[texel] = float(double(e[flipped ? 2 : 1]) * per_area);
                        dst.weight2[texel] = float(double(e[flipped ? 1 : 2]) * per_area);
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
