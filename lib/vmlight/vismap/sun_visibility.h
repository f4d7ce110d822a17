// SPDX-License-Identifier: Apache-2.0
/// How much of a disc of the sky, such as a sun, each texel of a mesh sees, traced.
#pragma once

#include <vmlight/base/progress.h>
#include <vmlight/math/disc.h>
#include <vmlight/trace/bake_scene.h>
#include <vmlight/trace/ground_plane.h>
#include <vmlight/trace/surface.h>
#include <vmlight/vismap/disc_look.h>
#include <vmlight/vismap/map_points.h>
#include <vmlight/vismap/normal_map.h>
#include <vmlight/vismap/open_triangles.h>
#include <vmlight/vismap/vismap.h>

#include <OpenImageIO/span.h>

#include <array>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

namespace vmlight {

/// Rays for a texel in the penumbra of a disc: 16, or 32 if its half angle is between 2 and 6 degrees. A power of 2.
/// Half as many find out before whether it is there.
int disc_rays(double half_angle);

/// The discs of VismapParams::sun_directions. Returns false, with the reason in `error`, if the text is not valid.
bool parse_sun_directions(std::vector<Disc>& dst, const std::string& text, std::string& error);
/// Text that parse_sun_directions() reads back.
std::string sun_directions_text(OIIO::cspan<Disc> discs);
/// Names of their channels: `sun.0`, ...; none if the text is not valid.
std::vector<std::string> sun_channels(const std::string& text);

/// Traces one disc for surface points of one scene, eight rays at a time. One per thread.
class DiscTracer
{
public:
    /// @param occluder, samples    must outlive this
    /// @param rays     per texel; divides DiscSamples::kCount
    /// @param length   of rays, in the units of `occluder`
    /// @param ground   hides what of the disc is below its horizon
    /// @param tries_blockers   as of DiscLook
    DiscTracer(const Occluder& occluder, const Disc& disc, const DiscSamples& samples, int rays, float length, int seed,
               const GroundPlane& ground, bool tries_blockers);

    /// Trace the disc for `point`, the centre of texel (x, y), whose ray origin adjust_ray_origins() has set. Its
    /// visibility goes to `*dst`, by the next flush() at the latest:
    ///     T = mean over the disc of vis(w) max(0, n.w),
    /// which is n.d (1 + cos a) / 2 where all of it is seen. As in visibility maps and the reference, directions below
    /// the geometric surface g are left out, and the result is divided by the share of the cosine above it, (1 + n.g)
    /// / 2. A texel whose horizon is above the disc gets 0 and traces no ray.
    /// @param is_open  nothing can block a ray of the point above its triangle: none is traced, for the same bits
    void add(const SurfacePoint& point, bool is_open, int x, int y, float* dst);
    /// Trace what is left.
    void flush();

    int64_t rays() const { return m_rays; }

private:
    struct Texel
    {
        float* dst;
        SurfacePoint point;
        uint32_t hash;
        double scale; // of a mean
        bool is_open, is_whole; // `is_whole`: the whole disc is above all horizons
        bool is_probe; // traced again with all rays if these do not agree
        float lowest; // GroundPlane::lowest_ray()
        double all = 0, seen = 0; // sums of cosines
        int rays_left = 0;
    };
    bool place(Texel& dst, const SurfacePoint& point, int x, int y) const;
    void start(const Texel& texel, int rays);
    void trace();
    void finish(const Texel& texel);

    const Occluder& m_occluder;
    const DiscSamples& m_samples;
    const DiscHorizon m_horizon;
    const double m_mean_length;
    const int m_rays_each;
    const float m_length;
    const uint32_t m_seed;
    const bool m_tries_blockers;
    RecentBlockers m_blockers;
    int64_t m_rays = 0;
    // Rays that wait for their packet to fill.
    int m_count = 0;
    bool m_is_near = false; // one of them is
    std::array<Imath::V3f, kPacketSize> m_origins, m_directions;
    std::array<double, kPacketSize> m_cosines {};
    std::array<size_t, kPacketSize> m_owner {};
    std::vector<Texel> m_texels, m_again;
};

/// The texels of a map, ready to trace discs, again and again as they turn.
class SunTracer
{
public:
    SunTracer();
    ~SunTracer();

    /// Find the points of all texels. Keeps them if they take no more than 256 MiB, else finds them each time.
    ///
    /// @param scene    built
    /// @param map      as for the visibility map of the same texels: size, UDIM tile, maximum distance, ground,
    ///                 margin and seed; and whether texels that nothing rises above are spared
    /// @param normal_map   likewise; nullptr without
    /// @returns false, with the reason in `error`, if a parameter is out of range or `progress` stopped the work
    bool prepare(BakeScenePointer scene, const VismapParams& map, std::string& error, int nthreads = 0,
                 const Progress& progress = {}, NormalMapPointer normal_map = nullptr);

    /// Trace `discs`, which are in object space.
    ///
    /// @param dst  set to one float for each disc, texel by texel: T of DiscTracer::add(), and in the margin the mean
    ///             of neighbours whose normals are alike; 0 elsewhere. The same bits for any number of threads
    /// @returns false if `progress` stopped the work
    bool trace(std::vector<float>& dst, OIIO::cspan<Disc> discs, int nthreads = 0, const Progress& progress = {});

    /// Rays of the last trace().
    int64_t rays() const { return m_rays; }
    size_t bytes() const;

private:
    std::unique_ptr<MapPoints> m_points;
    OpenTriangles m_open;
    bool m_tries_blockers = false;
    int64_t m_rays = 0;
};

} // namespace vmlight
