// SPDX-License-Identifier: Apache-2.0
/// What one point of a surface sees: the estimate behind each texel of a visibility map.
#pragma once

#include <vmlight/occluder.h>
#include <vmlight/sampling.h>
#include <vmlight/surface.h>
#include <vmlight/vismap.h>

#include <cstdint>
#include <limits>

namespace vmlight {

/// V and B, in double.
struct Visibility
{
    double visibility = 0;
    Imath::V3d direction { 0 };
};

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
        , m_fan(pattern.count())
    {
    }

    /// What `point`, the centre of texel (x, y), sees.
    Visibility see(SurfacePoint point, int x, int y);

    /// Traced so far.
    int64_t rays() const { return m_rays; }

private:
    const Occluder& m_occluder;
    const SamplePattern& m_pattern;
    const VismapParams& m_params;
    float m_length;
    RayFan m_fan;
    int64_t m_rays = 0;
};

} // namespace vmlight
