// SPDX-License-Identifier: Apache-2.0
/// What the rays of a tile of a map meet, as LightTransport keeps it.
#pragma once

#include <vmlight/math/sampling.h>
#include <vmlight/trace/ground_plane.h>
#include <vmlight/vismap/bounce_rays.h>
#include <vmlight/vismap/light_cells.h>
#include <vmlight/vismap/map_patches.h>
#include <vmlight/vismap/map_points.h>

#include <cstdint>
#include <vector>

namespace vmlight {

/// What is the same for all tiles of a map.
struct TransportMap
{
    TransportMap(BakeScenePointer scene, const VismapParams& map, NormalMapPointer normal_map, int rays,
                 bool ground_reflects);

    MapPoints points;
    MapPatches patches;
    const SamplePattern pattern;
    const GroundPlane ground;
    const bool ground_reflects;
    std::vector<float> visibility; ///< V of the texels; empty if it is unknown
    LightCells cells; ///< of all tiles
};

/// Which patches and cells light the texels of a tile.
struct TransportTile
{
    struct Receiver
    {
        uint16_t texel; ///< y * kTileSize + x
        uint16_t entries; ///< their number, after those of the receivers before
        float scale; ///< of a ray
    };

    /// An entry is a patch, or a cell counted on after the patches, and how many rays met it.
    static constexpr int kCountBits = 8;
    static constexpr uint32_t kMostNumbers = 1u << (32 - kCountBits);
    static constexpr int kMostRays = 248;
    static uint32_t number_of(uint32_t entry) { return entry >> kCountBits; }
    static uint32_t count_of(uint32_t entry) { return entry & ((1u << kCountBits) - 1); }

    std::vector<Receiver> receivers;
    std::vector<uint32_t> entries;
};

/// The rays of one tile, before the cells of all tiles are known.
struct TracedTile
{
    std::vector<TransportTile::Receiver> receivers;
    std::vector<uint32_t> met; ///< one number a ray, as BounceRays has them
    LightCells cells; ///< that `met` counts in
};

/// One per thread.
class TransportTracer
{
public:
    /// `map` must outlive this.
    explicit TransportTracer(const TransportMap& map);

    /// Trace the rays of a tile. The result lasts until the next call.
    TracedTile& trace(int tile);

    /// Sort and count what trace() found, by the cells of the map, which has all that are met.
    void count(TransportTile& dst, TracedTile& traced);

    /// Rays so far.
    int64_t rays() const { return m_rays.rays(); }

private:
    const TransportMap& m_map;
    BounceRays m_rays;
    MapPoints::ScratchPointer m_scratch;
    TracedTile m_traced;
    std::vector<uint32_t> m_numbers;
};

} // namespace vmlight
