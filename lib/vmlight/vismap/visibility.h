// SPDX-License-Identifier: Apache-2.0
/// What one point of a surface sees: the estimate behind each texel of a visibility map.
#pragma once

#include <vmlight/math/sampling.h>
#include <vmlight/trace/occluder.h>
#include <vmlight/trace/surface.h>
#include <vmlight/vismap/basis.h>
#include <vmlight/vismap/vismap.h>

#include <cstdint>
#include <limits>
#include <vector>

namespace vmlight {

/// V and B, in double.
struct Visibility
{
    double visibility = 0;
    /// Standard error of V, from lane_scatter(); only where the channel `error` is asked for.
    double error = 0;
    Imath::V3d direction { 0 };
};

/// Standard error of a share of rays, `seen` of `asked` (lanes as in RayFan): from how much lane 0 of all packets,
/// lane 1, ... differ. Each packet's rays are neighbours, so that each lane is spread over the hemisphere as all rays
/// are, and the eight together do better than eight sets of chance would: a bound. Measured on eight scenes, 1.6 to 2.5
/// times the error at 16 rays, 1.7 to 4.6 at 64, 1.9 to 6.5 at 256: what compares texels, until it is scaled. 0 if
/// fewer than two lanes have rays. Source: W. G. Cochran, "Sampling Techniques", 3rd ed., section 6.3 (variance of a
/// ratio).
double lane_scatter(const std::vector<uint8_t>& asked, const std::vector<uint8_t>& seen);

/// What a point of the surface sees. One to a thread.
class Eye
{
public:
    Eye(const Occluder& occluder, const SamplePattern& pattern, const VismapParams& params, double scale)
        : m_occluder(occluder)
        , m_pattern(pattern)
        , m_params(params)
        , m_length(params.max_distance > 0 ? float(params.max_distance * scale)
                                           : std::numeric_limits<float>::infinity())
        , m_wants_error(params.has("error"))
        , m_fan(pattern.count())
        , m_basis(params)
    {
    }

    /// What `point`, the centre of texel (x, y), sees: see adjust_ray_origins(). `basis` is set to the numbers of
    /// basis_channels().
    Visibility see(SurfacePoint point, int x, int y, float* basis = nullptr);

    /// Traced so far.
    int64_t rays() const { return m_rays; }

private:
    const Occluder& m_occluder;
    const SamplePattern& m_pattern;
    const VismapParams& m_params;
    float m_length;
    bool m_wants_error;
    RayFan m_fan;
    VisibilityBasis m_basis;
    std::vector<uint8_t> m_asked; // the lanes before they are asked about
    int64_t m_rays = 0;
};

} // namespace vmlight
