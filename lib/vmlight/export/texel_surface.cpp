// SPDX-License-Identifier: Apache-2.0
#include <vmlight/export/texel_surface.h>

#include <vmlight/base/parallel.h>
#include <vmlight/uv/raster.h>

#include <algorithm>
#include <memory>

namespace vmlight {

TexelSurface::TexelSurface(const Mesh& mesh, int width, int height, int udim, int nthreads)
    : m_mesh(mesh)
    , m_threads(nthreads)
    , m_coverage(width, height)
    , m_triangle(size_t(width) * size_t(height), TileCover::kNone)
    , m_weight1(m_triangle.size())
    , m_weight2(m_triangle.size())
{
    const UvRaster raster(mesh, width, height, udim);
    const auto cover = std::make_unique<TileCover>();
    for (int tile = 0; tile < raster.tiles_across() * raster.tiles_down(); ++tile) {
        raster.cover(tile, *cover);
        const int left = tile % raster.tiles_across() * kTileSize, top = tile / raster.tiles_across() * kTileSize;
        for (int y = 0; y < std::min(kTileSize, height - top); ++y)
            for (int x = 0; x < std::min(kTileSize, width - left); ++x) {
                const size_t from = size_t(y) * kTileSize + size_t(x);
                if (cover->triangle[from] == TileCover::kNone)
                    continue;
                const size_t to = size_t(top + y) * size_t(width) + size_t(left + x);
                m_triangle[to] = cover->triangle[from];
                m_weight1[to] = cover->weight1[from];
                m_weight2[to] = cover->weight2[from];
                m_coverage.set(left + x, top + y);
                ++m_covered;
            }
    }
}

void TexelSurface::for_each(const std::function<void(size_t index, const TangentSpace& frame)>& visit) const
{
    const std::vector<std::array<CornerTangent, 3>> tangents = make_tangents(m_mesh);
    const size_t width = size_t(m_coverage.width());
    parallel_items(m_coverage.height(), m_threads, [&](int64_t row, int) {
        for (size_t i = size_t(row) * width; i < size_t(row + 1) * width; ++i)
            if (const uint32_t triangle = m_triangle[i]; triangle != TileCover::kNone)
                visit(
                    i,
                    tangent_space(m_mesh, m_mesh.triangles[triangle], tangents[triangle], m_weight1[i], m_weight2[i]));
    });
}

} // namespace vmlight
