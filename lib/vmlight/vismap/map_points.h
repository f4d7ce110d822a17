// SPDX-License-Identifier: Apache-2.0
/// The points of a visibility map's texels, for what is traced besides the map itself.
#pragma once

#include <vmlight/base/progress.h>
#include <vmlight/trace/bake_scene.h>
#include <vmlight/trace/surface.h>
#include <vmlight/uv/margin.h>
#include <vmlight/uv/raster.h>
#include <vmlight/vismap/normal_map.h>
#include <vmlight/vismap/vismap.h>

#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <vector>

namespace vmlight {

struct MapPoint
{
    SurfacePoint surface; ///< its ray origin is adjusted
    uint32_t triangle; ///< of BakeScene::mesh()
    uint16_t x, y; ///< in the tile
};

class MapPoints
{
public:
    /// @param scene    built
    /// @param map      checked; of the visibility map of the same texels
    MapPoints(BakeScenePointer scene, const VismapParams& map, NormalMapPointer normal_map);
    ~MapPoints();

    const BakeScene& scene() const { return *m_scene; }
    const VismapParams& params() const { return m_params; }
    int width() const { return m_width; }
    int height() const { return m_height; }
    const UvRaster& raster() const { return m_raster; }
    int tiles() const { return m_raster.tiles_across() * m_raster.tiles_down(); }
    int left(int tile) const { return tile % m_raster.tiles_across() * kTileSize; }
    int top(int tile) const { return tile / m_raster.tiles_across() * kTileSize; }
    /// The index of a point's texel in the map, row by row.
    size_t texel(int tile, const MapPoint& point) const
    {
        return size_t(top(tile) + point.y) * size_t(m_width) + size_t(left(tile) + point.x);
    }

    /// Working memory of one thread.
    class Scratch;
    struct FreeScratch
    {
        void operator()(Scratch*) const;
    };
    using ScratchPointer = std::unique_ptr<Scratch, FreeScratch>;

    using Visit = std::function<void(int tile, const std::vector<MapPoint>& points)>;
    /// Find the margin, and the points of all tiles, which are kept if they take no more than `most_kept` bytes.
    ///
    /// @param visit    empty, or called once with each tile, from any thread
    /// @returns false if `progress` stopped the work
    bool prepare(size_t most_kept, int nthreads, const Progress& progress, const Visit& visit = {});

    /// The points of a tile: kept, or found again. Neighbours together, as rays that run side by side are faster.
    /// @param scratch  of the calling thread; made if it is nullptr and needed
    const std::vector<MapPoint>& of_tile(int tile, ScratchPointer& scratch) const;

    /// After prepare().
    const MarginPlan& margin() const { return m_margin; }
    size_t bytes() const;

private:
    const BakeScenePointer m_scene;
    const NormalMapPointer m_normal_map;
    const VismapParams m_params;
    const int m_width, m_height;
    const UvRaster m_raster;
    std::vector<std::vector<MapPoint>> m_points; // of each tile, or empty
    MarginPlan m_margin;
};

} // namespace vmlight
