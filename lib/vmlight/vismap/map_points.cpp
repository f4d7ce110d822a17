// SPDX-License-Identifier: Apache-2.0
#include <vmlight/vismap/map_points.h>

#include <vmlight/base/parallel.h>

#include <algorithm>
#include <array>

namespace vmlight {

class MapPoints::Scratch
{
public:
    Scratch(const BakeScene& scene, const NormalMap* normal_map)
        : m_surface(scene.mesh(), scene.frame())
        , m_occluder(scene.occluder())
        , m_normal_map(normal_map)
    {
    }

    std::vector<MapPoint> points;

    void find(const UvRaster& raster, int tile)
    {
        points.clear();
        raster.cover(tile, m_cover);
        std::array<SurfacePoint, kPacketSize> row;
        for (int i = 0; i < kTileSize * kTileSize / 8 && m_cover.covered > 0; ++i) {
            const int block = i / 8, left = block % 8 * 8, y = block / 8 * 8 + i % 8;
            const size_t before = points.size();
            for (int x = left; x < left + 8; ++x) {
                const size_t texel = size_t(y) * kTileSize + size_t(x);
                const uint32_t triangle = m_cover.triangle[texel];
                if (triangle == TileCover::kNone)
                    continue;
                points.push_back({ m_surface.at(triangle, m_cover.weight1[texel], m_cover.weight2[texel]), triangle,
                                   uint16_t(x), uint16_t(y) });
                if (m_normal_map)
                    m_normal_map->apply(points.back().surface, triangle, m_cover.weight1[texel], m_cover.weight2[texel],
                                        tile % raster.tiles_across() * kTileSize + x,
                                        tile / raster.tiles_across() * kTileSize + y);
            }
            const int count = int(points.size() - before);
            for (int k = 0; k < count; ++k)
                row[size_t(k)] = points[before + size_t(k)].surface;
            if (count > 0)
                adjust_ray_origins(row.data(), count, m_occluder);
            for (int k = 0; k < count; ++k)
                points[before + size_t(k)].surface = row[size_t(k)];
        }
    }

private:
    Surface m_surface;
    const Occluder& m_occluder;
    const NormalMap* m_normal_map;
    TileCover m_cover;
};

void MapPoints::FreeScratch::operator()(Scratch* scratch) const
{
    delete scratch;
}

MapPoints::MapPoints(BakeScenePointer scene, const VismapParams& map, NormalMapPointer normal_map)
    : m_scene(std::move(scene))
    , m_normal_map(std::move(normal_map))
    , m_params(map)
    , m_width(map.size().width)
    , m_height(map.size().height)
    , m_raster(m_scene->mesh(), m_width, m_height, map.udim)
{
}

MapPoints::~MapPoints() = default;

bool MapPoints::prepare(size_t most_kept, int nthreads, const Progress& progress, const Visit& visit)
{
    const size_t texels = size_t(m_width) * size_t(m_height);
    const bool keeps_points = texels * sizeof(MapPoint) <= most_kept;
    m_points.clear();
    m_margin = {};
    std::vector<std::vector<MapPoint>> kept(keeps_points ? size_t(tiles()) : 0);
    // A normal where V and B of a visibility map are: what the margin goes by.
    std::vector<float> normals(4 * texels);
    Coverage covered(m_width, m_height);
    std::vector<ScratchPointer> workers(size_t(worker_count(nthreads)));
    const auto find = [&](int64_t tile, int index) {
        const std::vector<MapPoint>& points = of_tile(int(tile), workers[size_t(index)]);
        std::array<uint64_t, kTileSize> bits {};
        for (const MapPoint& point : points) {
            bits[point.y] |= uint64_t(1) << point.x;
            for (int c = 0; c < 3; ++c)
                normals[4 * texel(int(tile), point) + 1 + size_t(c)] = point.surface.normal[c];
        }
        for (int row = 0; row < std::min(kTileSize, m_height - top(int(tile))); ++row)
            covered.set_word(left(int(tile)), top(int(tile)) + row, bits[size_t(row)]);
        if (keeps_points)
            kept[size_t(tile)] = points;
        if (visit)
            visit(int(tile), points);
    };
    if (!parallel_items(tiles(), nthreads, find, progress))
        return false;
    m_points = std::move(kept);
    fill_margin(normals.data(), 4, covered, m_params.margin, {}, &m_margin);
    return true;
}

const std::vector<MapPoint>& MapPoints::of_tile(int tile, ScratchPointer& scratch) const
{
    if (!m_points.empty())
        return m_points[size_t(tile)];
    if (!scratch)
        scratch.reset(new Scratch(*m_scene, m_normal_map.get()));
    scratch->find(m_raster, tile);
    return scratch->points;
}

size_t MapPoints::bytes() const
{
    size_t bytes = m_margin.bytes();
    for (const auto& points : m_points)
        bytes += points.capacity() * sizeof(MapPoint);
    return bytes;
}

} // namespace vmlight
