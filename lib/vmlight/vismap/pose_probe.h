// SPDX-License-Identifier: Apache-2.0
/// How much of what a texel sees differs between two poses, from the same rays in both.
#pragma once

#include <vmlight/math/rotation.h>
#include <vmlight/math/sampling.h>
#include <vmlight/trace/bake_scene.h>
#include <vmlight/trace/ground_plane.h>
#include <vmlight/trace/surface.h>
#include <vmlight/vismap/bake_hints.h>
#include <vmlight/vismap/normal_map.h>
#include <vmlight/vismap/vismap.h>

#include <cstdint>

namespace vmlight {

/// A map in one pose.
struct PosedMap
{
    BakeScenePointer scene;
    NormalMapPointer normal_map; ///< nullptr if there is none
};

/// One per thread.
class PoseProbe
{
public:
    /// All must outlive this.
    /// @param hints    nullptr, or what is known of the rays of the base
    PoseProbe(const PosedMap& base, const PosedMap& pose, const VismapParams& params, const SamplePattern& pattern,
              const BakeHints* hints = nullptr);

    /// The share of the texel's rays that are blocked in one pose and not in the other, if the texel turns by `turn`
    /// and its rays with it, plus how far its normal turns otherwise, in radians; at most 1. By what is known of so
    /// many rays, V and B of the texel (turned) differ by no more, nor does light that is nowhere brighter than 1.
    double change(uint32_t triangle, float weight1, float weight2, int x, int y, const Rotation& turn);

    /// Rays traced so far.
    int64_t rays() const { return m_rays; }

private:
    struct Side
    {
        Side(const PosedMap& map, const VismapParams& params, const SamplePattern& pattern);
        // Leave of the fan what nothing blocks. Returns how many rays are traced.
        int64_t trace(const SurfacePoint& point);

        const PosedMap& map;
        const GroundPlane ground;
        const float length;
        Surface surface;
        RayFan fan;
    };
    // The same, of a texel that stands still and whose rays in the base are known.
    double change_of_known(const SurfacePoint& point, const uint8_t* known, Point32 texel);
    SurfacePoint point_of(Side& side, uint32_t triangle, float weight1, float weight2, int x, int y) const;

    const VismapParams& m_params;
    const SamplePattern& m_pattern;
    const BakeHints* m_hints;
    Side m_base, m_pose;
    int64_t m_rays = 0;
};

} // namespace vmlight
