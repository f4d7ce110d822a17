// SPDX-License-Identifier: Apache-2.0
/// Where something is, or was, that stands elsewhere in another pose: rays that miss it meet what they met.
#pragma once

#include <vmlight/math/ray_fan.h>
#include <vmlight/trace/horizon.h>
#include <vmlight/trace/pose_motion.h>
#include <vmlight/trace/surface.h>

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace vmlight {

class MovedBoxes
{
public:
    static constexpr size_t kMost = 16;

    /// Around all that rays can meet and that is not of the body that stands still (the first of `motion`, if its
    /// motion is one): in both poses, in the scene of the second.
    explicit MovedBoxes(const PoseMotion& motion);

    /// Whether nothing moves.
    bool empty() const { return m_boxes.empty(); }

    /// Those that rays of `point` can reach within `length`.
    struct Near
    {
        std::array<SceneBox, kMost> boxes;
        size_t count = 0;
        SceneBox all;
    };
    void find_near(Near& dst, const SurfacePoint& point, float length) const;

    /// Which rays of a packet may meet something in one of the boxes within `length`: bit k for ray k. Never too few.
    static uint8_t may_meet(const Near& near, const RayFan& fan, int packet, const Imath::V3f& origin, float length);

private:
    std::vector<SceneBox> m_boxes;
};

} // namespace vmlight
