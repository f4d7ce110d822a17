// SPDX-License-Identifier: Apache-2.0
/// The rays of one texel to the surfaces that light it.
#pragma once

#include <vmlight/math/ray_fan.h>
#include <vmlight/math/sampling.h>
#include <vmlight/trace/ground_plane.h>
#include <vmlight/vismap/light_cells.h>
#include <vmlight/vismap/map_patches.h>

#include <array>
#include <cstdint>
#include <vector>

namespace vmlight {

/// Of one thread.
class BounceRays
{
public:
    /// What a ray met is a patch, or with this bit a cell of cells().
    static constexpr uint32_t kCell = 0x80000000u;

    /// Which rays to trace: 0 others than those of the bake, so that their errors are independent; 1 those of the bake,
    /// which have met something wherever V is below 1, unless it is reconstructed; from 2 on others each time.
    enum : int
    {
        kOwnRays = 0,
        kRaysOfBake = 1
    };

    /// @param map, patches, pattern, bake_pattern  must outlive this
    /// @param ground   reflects light if `ground_reflects`
    BounceRays(const MapPoints& map, const MapPatches& patches, const SamplePattern& pattern,
               const SamplePattern& bake_pattern, const GroundPlane& ground, bool ground_reflects);

    struct Count
    {
        int all = 0; ///< directions of the hemisphere that count
        int blocked = 0; ///< of those, that something is in the way of, black or not
    };
    /// Trace the rays of `point`, which is texel number `texel` at (x, y), and append what each meets to `met`, but for
    /// what is black.
    Count trace(const SurfacePoint& point, size_t texel, int x, int y, std::vector<uint32_t>& met,
                int round = kOwnRays);

    LightCells& cells() { return m_cells; }
    int64_t rays() const { return m_rays; }

private:
    void flush(const SurfacePoint& point, Count& count, std::vector<uint32_t>& met);
    void meet_ground(const Imath::V3f& position, float distance, std::vector<uint32_t>& met);
    void meet(const SurfacePoint& point, const Imath::V3f& direction, const NearestHit& hit,
              std::vector<uint32_t>& met);

    const MapPoints& m_map;
    const MapPatches& m_patches;
    const SamplePattern &m_pattern, &m_bake_pattern;
    const GroundPlane m_ground;
    const bool m_ground_reflects;
    const float m_length;
    RayFan m_fan, m_bake_fan;
    LightCells m_cells;
    int64_t m_rays = 0;
    // Rays that wait for their packet to fill.
    int m_waiting = 0;
    std::array<Imath::V3f, kPacketSize> m_origins, m_directions;
    std::array<float, kPacketSize> m_lengths {};
    std::array<bool, kPacketSize> m_ends_on_ground {};
    std::array<NearestHit, kPacketSize> m_hits;
};

} // namespace vmlight
