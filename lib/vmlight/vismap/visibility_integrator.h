// SPDX-License-Identifier: Apache-2.0
/// The rays of one texel: the estimate of V, B and the basis behind each texel of a visibility map.
#pragma once

#include <vmlight/math/sampling.h>
#include <vmlight/trace/ground_plane.h>
#include <vmlight/trace/occluder.h>
#include <vmlight/trace/surface.h>
#include <vmlight/vismap/basis.h>
#include <vmlight/vismap/ray_bits.h>
#include <vmlight/vismap/reconstruct.h>
#include <vmlight/vismap/vismap.h>

#include <cstdint>
#include <memory>
#include <vector>

namespace vmlight {

/// V and B, in double; |B| is at most longest_direction(V).
struct Visibility
{
    double visibility = 0;
    /// Of V, up to a factor: lane_scatter(), or where maps are reconstructed independent_error(); 0 where neither that
    /// nor the channel `error` is asked for.
    double error = 0;
    Imath::V3d direction { 0 };
};

/// Standard error of the share of rays that nothing blocks, `open` of `traced` (lane bits as in RayFan), from the
/// scatter of lane 0 of all packets, lane 1, ... A packet's rays are neighbours, so that each lane covers the
/// hemisphere as the whole fan does, and the eight lanes together do better than eight random sets would: an upper
/// bound. Measured on eight scenes: 1.6 to 2.5 times the error at 16 rays, 1.7 to 4.6 at 64, 1.9 to 6.5 at 256. It
/// ranks texels; the caller scales it. 0 if fewer than two lanes have rays.
/// Source: W. G. Cochran, "Sampling Techniques", 3rd ed., section 6.3 (variance of a ratio).
double lane_scatter(const std::vector<uint8_t>& traced, const std::vector<uint8_t>& open);

/// Standard error of the share of rays that nothing blocks, if they were independent: far above that of the samplers,
/// but as smooth from texel to texel as V is, and 0 only where all rays agree. The scatter of lanes is 0 by chance,
/// too: with two rays in each lane reconstruction leaves 1.6 times the error, with 1, 3 or 6 as much (within 5 %).
double independent_error(int64_t open, int64_t traced);

/// The variance of V by a pattern of rays, from what it would be if they were independent: of rays that are rarely
/// blocked (or rarely not) nearly that, elsewhere no more than the square of `pattern_error`, since a pattern is off
/// beside the edges of occluders alone, by about one ray. Measured on ten meshes: within 25 % for each V.
inline double pattern_variance(double independent, double pattern_error)
{
    const double most = pattern_error * pattern_error;
    return independent > 0 ? independent * most / (independent + most) : 0;
}

/// Traces the rays of one surface point at a time. One per thread.
class VisibilityIntegrator
{
public:
    /// @param occluder, pattern, params  must outlive this
    /// @param scale    from mesh units to the units of `occluder`, for VismapParams::max_distance
    VisibilityIntegrator(const Occluder& occluder, const SamplePattern& pattern, const VismapParams& params,
                         double scale, const GroundPlane& ground = {})
        : m_occluder(occluder)
        , m_pattern(pattern)
        , m_params(params)
        , m_ground(ground)
        , m_length(float(params.max_distance * scale))
        , m_is_reconstructed(is_reconstructed(params))
        , m_wants_error(m_is_reconstructed || params.has("error"))
        , m_fan(pattern.count())
        , m_basis(make_accumulator(params))
    {
    }
    /// Adds what the ground blocked to WorkCounts.
    ~VisibilityIntegrator();

    /// Integrate visibility over the hemisphere of `point`, whose ray origin adjust_ray_origins() has set. A function
    /// of scene, params, point and `texel` alone. Directions below the geometric surface are left out: they are an
    /// error of the mesh's interpolated normal. Under a normal map that is so above the mesh's normal only, and what is
    /// below both is blocked by the surface itself.
    ///
    /// @param texel    SamplePattern::texel(), or texel_hash() for rays that are independent of all others
    /// @param open     no triangle can block a ray of the point: none is traced, and the result has the same bits. The
    ///                 ground still blocks, and the ray origin may be as it was
    /// @param basis    nullptr, or set to one number for each of basis_channels()
    /// @param memory   what is known of the rays; it changes no bit of the result
    Visibility integrate(SurfacePoint point, Point32 texel, bool open, float* basis = nullptr,
                         const RayMemory& memory = {});

    /// Rays traced so far.
    int64_t rays() const { return m_rays; }

private:
    // Rays of the fan for which is_out(direction) is true.
    template <class Test> void take_out(const Test& is_out);
    // Trace the rays of the fan of which it is not known that they meet what they met.
    void trace_unknown(const SurfacePoint& point);
    // Trace the fan, of which `above` is left, and set V, B and their error. Returns what is seen.
    DirectionSums trace(Visibility& dst, const SurfacePoint& point, const DirectionSums& all,
                        const DirectionSums& above, bool open);
    // Trace what the ground leaves of the fan, and set V, B and their error.
    void trace_over_ground(Visibility& dst, const SurfacePoint& point, const DirectionSums& all, bool open,
                           bool is_mapped);
    // Visibility::error of what is left of `traced` in the fan.
    double error_of(const std::vector<uint8_t>& traced) const;
    // B of the rays, however long.
    Imath::V3d mean_direction(const DirectionSums& seen, const DirectionSums& all, const Imath::V3f& normal) const;

    const Occluder& m_occluder;
    const SamplePattern& m_pattern;
    const VismapParams& m_params;
    const GroundPlane m_ground;
    float m_length;
    bool m_is_reconstructed, m_wants_error;
    RayFan m_fan;
    std::unique_ptr<BasisAccumulator> m_basis;
    std::vector<uint8_t> m_traced, m_traced_above; // lane bits before the rays are traced; and above the ground
    RayMemory m_memory; // of the texel
    std::vector<uint8_t> m_kept; // lane bits of rays that are known to be open
    int64_t m_rays = 0;
    int64_t m_below_ground = 0; // directions that the ground blocked, for which no ray was traced
};

} // namespace vmlight
