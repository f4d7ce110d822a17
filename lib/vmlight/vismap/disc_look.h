// SPDX-License-Identifier: Apache-2.0
/// One ray for each texel: whether a disc of the sky, such as a sun, is seen at all, as most texels see all of it or
/// none.
#pragma once

#include <vmlight/math/disc.h>
#include <vmlight/trace/blocker.h>
#include <vmlight/trace/ground_plane.h>
#include <vmlight/trace/surface.h>
#include <vmlight/vismap/penumbra.h>

#include <array>
#include <cstdint>

namespace vmlight {

/// How much of a disc is above the horizons of a texel: its normals' and the ground's.
enum class DiscHeight
{
    below,
    cut, ///< some horizon may cut it
    whole
};

/// A disc, as it stands above the horizons of texels.
struct DiscHorizon
{
    DiscHorizon(const Disc& disc, const GroundPlane& own_ground)
        : direction(disc.direction)
        , sine(std::sin(disc.half_angle))
        , ground(own_ground)
    {
    }

    DiscHeight height(const SurfacePoint& point) const
    {
        const double facing = Imath::V3d(point.normal).dot(direction),
                     above = Imath::V3d(point.geometric_normal).dot(direction), lowest = ground.lowest_ray(point);
        if (facing <= -sine || above <= -sine || direction.y + sine < lowest)
            return DiscHeight::below;
        return facing >= sine && above >= sine && direction.y - sine >= lowest ? DiscHeight::whole : DiscHeight::cut;
    }
    /// What is left out below the geometric surface: of a mean over the hemisphere, the share that counts. What a
    /// normal map adds is in front of the surface or behind it, and not left out.
    static double counted(const SurfacePoint& point)
    {
        return (1 + Imath::V3d(point.mesh_normal).dot(Imath::V3d(point.geometric_normal))) / 2;
    }

    const Imath::V3d direction;
    const double sine;
    const GroundPlane ground;
};

/// Looks at one disc from texels of one tile, eight rays at a time. One per thread and tile.
class DiscLook
{
public:
    /// @param occluder, samples, looked    must outlive this
    /// @param length   of rays, in the units of `occluder`
    /// @param looked   set for each texel that was looked at
    /// @param tries_blockers   try the triangles that blocked a ray before tracing the next: fewer rays, the same bits
    DiscLook(const Occluder& occluder, const Disc& disc, const DiscSamples& samples, float length, int seed,
             const GroundPlane& ground, LookedTile& looked, bool tries_blockers);

    /// Look from `point`, of column and row `x`, `y` of the tile whose first texel is (left, top), along one ray, if
    /// the whole disc is above its horizons. Then `*dst` is set, by the next flush() at the latest: to T of
    /// DiscTracer::add() as if the whole disc were alike.
    /// @param is_open  nothing can block a ray of the point above its triangle: none is traced, for the same bits
    DiscHeight add(const SurfacePoint& point, bool is_open, int left, int top, int x, int y, float* dst);
    /// Trace what is left.
    void flush();

    int64_t rays() const { return m_rays; }

private:
    struct Waiting
    {
        float* dst;
        float value; // where the ray meets nothing
        uint8_t x, y;
    };

    const Occluder& m_occluder;
    const DiscSamples& m_samples;
    const DiscHorizon m_horizon;
    const double m_mean_length;
    const float m_length;
    const uint32_t m_seed;
    LookedTile& m_looked;
    const bool m_tries_blockers;
    RecentBlockers m_blockers;
    int64_t m_rays = 0;
    int m_count = 0;
    bool m_is_near = false; // one of them is
    std::array<Imath::V3f, kPacketSize> m_origins, m_directions;
    std::array<Waiting, kPacketSize> m_waiting;
};

} // namespace vmlight
