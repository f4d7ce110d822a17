// SPDX-License-Identifier: Apache-2.0
/// Which texels the ground hides from in two poses alike.
#pragma once

#include <vmlight/trace/ground_plane.h>
#include <vmlight/trace/pose_motion.h>
#include <vmlight/trace/surface.h>
#include <vmlight/vismap/vismap.h>

#include <cstdint>
#include <vector>

namespace vmlight {

/// Of all triangles of the baked mesh: how the ground hides what their texels see.
class PoseGround
{
public:
    enum Keeps : uint8_t
    {
        none, ///< the ground may block other rays of its texels
        by_side, ///< as `all`, for texels that are on the same side of the ground in both poses: see GroundSides
        all ///< none of its texels sees a change
    };

    /// @param error    share of a texel's rays that the ground may block in one pose only, for rays that turn with the
    ///                 triangle; what the rounding of normals in files does (kSameNormal) is always allowed
    PoseGround(const PoseMotion& motion, const VismapParams& params, double error);

    Keeps keeps(uint32_t triangle) const { return m_keeps.empty() ? all : Keeps(m_keeps[triangle]); }
    /// Whether the ground changes nothing of any texel.
    bool keeps_all() const;

private:
    std::vector<uint8_t> m_keeps; // empty without a ground
};

/// On which side of the ground texels are, as they are baked. One per thread.
class GroundSides
{
public:
    GroundSides(const PoseMotion& motion, const VismapParams& params);

    /// Whether the point with these weights is below the ground in both poses, or in neither.
    bool are_same(uint32_t triangle, float weight1, float weight2);

private:
    const GroundPlane m_ground_before, m_ground_after;
    Surface m_before, m_after;
};

/// Whether both poses have the same ground, or none, in the same scene: to the bit.
bool is_same_ground(const BakeScene& base, const BakeScene& pose, const VismapParams& params);

} // namespace vmlight
