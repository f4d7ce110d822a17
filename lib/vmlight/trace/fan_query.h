// SPDX-License-Identifier: Apache-2.0
/// Rays of a fan, traced in packets: for triangles and for strands.
#pragma once

#include <vmlight/math/ray_fan.h>
#include <vmlight/trace/embree.h>
#include <vmlight/trace/embree_scene.h>

#include <cstring>

namespace vmlight::embree {

/// Clear the lane bits of the fan's rays that `scene` blocks between `nearest` and `length`, both in its units. The
/// caller flushes denormals.
inline void clear_blocked(RayFan& fan, Query& query, RTCScene scene, const Imath::V3f& origin, float nearest,
                          float length)
{
    RTCRay8 rays;
    for (int lane = 0; lane < kPacketSize; ++lane) {
        rays.org_x[lane] = origin.x;
        rays.org_y[lane] = origin.y;
        rays.org_z[lane] = origin.z;
        prepare_lane(rays, lane);
        rays.tnear[lane] = nearest;
    }
    for (int packet = 0; packet < fan.packets; ++packet) {
        const uint8_t live = fan.lanes[size_t(packet)];
        if (!live)
            continue;
        alignas(32) int valid[kPacketSize];
        for (int lane = 0; lane < kPacketSize; ++lane) {
            valid[lane] = live >> lane & 1 ? -1 : 0;
            rays.tfar[lane] = length;
        }
        const int first = packet * kPacketSize;
        std::memcpy(rays.dir_x, fan.x + first, sizeof(rays.dir_x));
        std::memcpy(rays.dir_y, fan.y + first, sizeof(rays.dir_y));
        std::memcpy(rays.dir_z, fan.z + first, sizeof(rays.dir_z));
        query.occluded8(valid, scene, rays);
        uint8_t open = 0;
        for (int lane = 0; lane < kPacketSize; ++lane)
            open |= uint8_t(rays.tfar[lane] >= 0) << lane; // Embree sets tfar to -infinity where a ray is blocked
        fan.lanes[size_t(packet)] = live & open;
    }
}

} // namespace vmlight::embree
