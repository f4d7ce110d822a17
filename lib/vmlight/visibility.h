// SPDX-License-Identifier: Apache-2.0
/// What one point of a surface sees: the estimate behind each texel of a visibility map.
#pragma once

#include <vmlight/occluder.h>
#include <vmlight/sampling.h>
#include <vmlight/surface.h>
#include <vmlight/visibility_basis.h>
#include <vmlight/vismap.h>

#include <cstdint>
#include <limits>
#include <vector>

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
        , m_basis(params)
    {
    }

    /// What `point`, the centre of texel (x, y), sees. `basis` is set to the numbers of basis_channels().
    Visibility see(SurfacePoint point, int x, int y, float* basis = nullptr);

    /// Traced so far.
    int64_t rays() const { return m_rays; }

private:
    const Occluder& m_occluder;
    const SamplePattern& m_pattern;
    const VismapParams& m_params;
    float m_length;
    RayFan m_fan;
    VisibilityBasis m_basis;
    std::vector<uint8_t> m_asked;
    int64_t m_rays = 0;
};

} // namespace vmlight
