// SPDX-License-Identifier: Apache-2.0
#include <vmlight/trace/moved_boxes.h>

#include <algorithm>
#include <cmath>

namespace vmlight {

using Imath::V3d;
using Imath::V3f;

namespace {

// Around each box, of its distance from the origin of the scene: more than all rounding on the way of a ray.
constexpr float kAround = 4 * float(kRayOffset);

float around(const SceneBox& box)
{
    float far = 1;
    for (int axis = 0; axis < 3; ++axis)
        far = std::max({ far, std::abs(box.low[axis]), std::abs(box.high[axis]) });
    return kAround * far;
}

// Halve the boxes by their middles until there are as many groups as are wanted.
void group(std::vector<SceneBox>& dst, SceneBox* begin, SceneBox* end, size_t groups)
{
    SceneBox all, middles;
    for (const SceneBox* box = begin; box != end; ++box) {
        all.add(*box);
        middles.add(box->low + box->high);
    }
    const size_t count = size_t(end - begin);
    if (groups == 1 || count <= 1) {
        if (count > 0)
            dst.push_back(all);
        return;
    }
    const V3f size = middles.high - middles.low;
    const int axis = size.x >= size.y && size.x >= size.z ? 0 : size.y >= size.z ? 1 : 2;
    SceneBox* const middle = begin + count / 2;
    std::nth_element(begin, middle, end, [axis](const SceneBox& a, const SceneBox& b) {
        return a.low[axis] + a.high[axis] < b.low[axis] + b.high[axis];
    });
    group(dst, begin, middle, groups / 2);
    group(dst, middle, end, groups / 2);
}

// One over the directions of a packet.
struct PacketInverse
{
    PacketInverse(const RayFan& fan, int packet)
    {
        const std::array<const float*, 3> direction { fan.x + packet * kPacketSize, fan.y + packet * kPacketSize,
                                                      fan.z + packet * kPacketSize };
        for (size_t axis = 0; axis < 3; ++axis)
            for (size_t lane = 0; lane < kPacketSize; ++lane) {
                const float d = direction[axis][lane];
                at[axis][lane] = 1 / (std::abs(d) > 1e-12f ? d : 1e-12f);
            }
    }
    std::array<std::array<float, kPacketSize>, 3> at;
};

// Which rays of the packet enter the box: bit k for ray k.
uint8_t enter(const SceneBox& box, const PacketInverse& inverse, const V3f& origin, float length)
{
    std::array<float, kPacketSize> enters {}, leaves;
    leaves.fill(length);
    for (int axis = 0; axis < 3; ++axis) {
        const float low = box.low[axis] - origin[axis], high = box.high[axis] - origin[axis];
        for (size_t lane = 0; lane < kPacketSize; ++lane) {
            const float a = low * inverse.at[size_t(axis)][lane], b = high * inverse.at[size_t(axis)][lane];
            enters[lane] = std::max(enters[lane], std::min(a, b));
            leaves[lane] = std::min(leaves[lane], std::max(a, b));
        }
    }
    uint8_t bits = 0;
    for (size_t lane = 0; lane < kPacketSize; ++lane)
        bits |= uint8_t((enters[lane] <= leaves[lane]) << lane);
    return bits;
}

} // namespace

MovedBoxes::MovedBoxes(const PoseMotion& motion)
{
    const BakeScene &base = motion.base(), &pose = motion.pose();
    const double scale = pose.frame().scale / base.frame().scale;
    const V3d shift = (base.frame().centre - pose.frame().centre) * pose.frame().scale;
    std::vector<SceneBox> boxes;
    size_t at = 0;
    for (const PosedPart& part : motion.parts())
        for (size_t i = 0; i < part.count(); ++i, ++at) {
            if (motion.stands_still() && motion.body_of_traced(at) == 0)
                continue;
            SceneBox box;
            for (int k = 0; k < 3; ++k) {
                if (part.base.count > 0)
                    box.add(V3f(V3d(part.base.corner(i, k)) * scale + shift));
                if (part.pose.count > 0)
                    box.add(part.pose.corner(i, k));
            }
            boxes.push_back(box);
        }
    group(m_boxes, boxes.data(), boxes.data() + boxes.size(), kMost);
    for (SceneBox& box : m_boxes) {
        const float far = around(box);
        box.low -= V3f(far);
        box.high += V3f(far);
    }
}

void MovedBoxes::find_near(Near& dst, const SurfacePoint& point, float length) const
{
    dst = {};
    const V3f& n = point.geometric_normal;
    SceneBox origin;
    origin.add(point.origin);
    for (const SceneBox& box : m_boxes) {
        float top = 0;
        for (int axis = 0; axis < 3; ++axis)
            top += n[axis] * ((n[axis] > 0 ? box.high[axis] : box.low[axis]) - point.origin[axis]);
        // Rays start above the surface; the box has a margin.
        if (!(top <= 0) && !(box.distance2(origin) > double(length) * double(length))) {
            dst.boxes[dst.count++] = box;
            dst.all.add(box);
        }
    }
}

uint8_t MovedBoxes::may_meet(const Near& near, const RayFan& fan, int packet, const V3f& origin, float length)
{
    if (near.count == 0)
        return 0;
    const PacketInverse inverse(fan, packet);
    // Rays of a packet are neighbours: most of them miss everything.
    const uint8_t candidates = enter(near.all, inverse, origin, length);
    uint8_t meets = 0;
    for (size_t i = 0; i < near.count && meets != candidates; ++i)
        meets |= uint8_t(candidates & enter(near.boxes[i], inverse, origin, length));
    return meets;
}

} // namespace vmlight
