// SPDX-License-Identifier: Apache-2.0
#include <vmlight/trace/pose_motion.h>

#include <vmlight/base/format.h>
#include <vmlight/math/sampling.h>
#include <vmlight/trace/surface.h>

#include <algorithm>
#include <array>
#include <cmath>

namespace vmlight {

using Imath::V3d;
using Imath::V3f;

namespace {

// Nearer than this in both poses is the same place: rays do not tell such triangles apart.
constexpr double kSamePlace = kTinyTriangle;
// Four roundings of a coordinate to a float, in the plane of a triangle.
constexpr double kFloatRounding = 1.0 / (1 << 22);
// Seeds that are tried for a body, and triangles that are asked whether they belong to it.
constexpr uint32_t kTries = 32;
constexpr size_t kAsked = 1024;
// A body has at least so many triangles, and this share of the scene: what is less moves on its own.
constexpr size_t kFewest = 2;
constexpr double kSmallest = 0.002;

// Three corners that span a plane.
bool has_shape(const V3d* corner)
{
    const V3d a = corner[1] - corner[0], b = corner[2] - corner[0], c = corner[2] - corner[1];
    return a.cross(b).length() > 1e-2 * std::max({ a.length2(), b.length2(), c.length2() });
}

} // namespace

PoseTriangles::PoseTriangles(const BakeScene& pose, const BakeScene& first, const std::vector<PosedPart>& parts,
                             TracedTriangles PosedPart::*side)
    : m_scene(pose)
    , m_scale(first.frame().scale / pose.frame().scale)
    , m_count(pose.mesh().triangles.size())
{
    for (const PosedPart& part : parts) {
        m_traced.push_back(part.*side);
        m_first.push_back(m_count);
        m_count += part.count();
    }
}

void PoseTriangles::corners(size_t triangle, V3d* dst) const
{
    if (triangle < baked()) {
        const auto& corner = m_scene.mesh().triangles[triangle];
        for (size_t k = 0; k < 3; ++k)
            dst[k] = V3d(m_scene.frame().to_scene(m_scene.mesh().positions[corner[k]])) * m_scale;
        return;
    }
    const size_t part = size_t(std::upper_bound(m_first.begin(), m_first.end(), triangle) - m_first.begin()) - 1;
    for (int k = 0; k < 3; ++k)
        dst[k] = V3d(m_traced[part].corner(triangle - m_first[part], k)) * m_scale;
}

PoseMotion::PoseMotion(const BakeScene& base, const BakeScene& pose)
    : m_base(base)
    , m_pose(pose)
    , m_parts(match_parts(base, pose, m_fault))
    , m_before(base, base, m_parts, &PosedPart::base)
    , m_after(pose, base, m_parts, &PosedPart::pose)
{
    if (m_before.baked() != m_after.baked())
        m_fault = "the baked mesh has a different number of triangles";
    if (!m_fault.empty())
        return;
    m_tolerance = std::max(kSamePlace, 4 * (base.rounding() + pose.rounding()));
    m_is_same_scene = base.frame().scale == pose.frame().scale && base.frame().centre == pose.frame().centre;
    m_box.add(V3f(-1));
    m_box.add(V3f(1));
    m_box_to.add(V3f(float(-base.frame().scale / pose.frame().scale)));
    m_box_to.add(V3f(float(base.frame().scale / pose.frame().scale)));
    m_body.assign(m_before.count(), kSoft);
    size_t first = m_before.baked();
    for (const PosedPart& part : m_parts) {
        if (!part.is_in_both()) {
            std::fill_n(m_body.begin() + int64_t(first), part.count(), kAway);
            m_away += int64_t(part.count());
        }
        first += part.count();
    }
    m_soft = int64_t(m_body.size()) - m_away;
    m_stands_still = take({ Rotation(), (base.frame().centre - pose.frame().centre) * base.frame().scale }) > 0;
    while (m_soft > 0 && m_motions.size() < kMotions) {
        std::vector<uint32_t> left;
        for (size_t i = 0; i < m_body.size(); ++i)
            if (m_body[i] == kSoft)
                left.push_back(uint32_t(i));
        RigidMotion motion;
        if (!find_body(motion, left) || take(motion) == 0)
            break;
    }
}

bool PoseMotion::fits(size_t triangle, const RigidMotion& motion, double slack) const
{
    std::array<V3d, 3> before, after;
    m_before.corners(triangle, before.data());
    m_after.corners(triangle, after.data());
    if (m_is_same_scene && is_straight(motion.turn) && motion.shift == V3d(0))
        return before == after; // what is traced stays, to the bit
    SceneBox box, box_to;
    for (size_t k = 0; k < 3; ++k) {
        box.add(V3f(before[k]));
        box_to.add(V3f(after[k]));
    }
    // What is far looks smaller. How far corners are does not matter: a wide plane may pass close by.
    const double nearest = std::sqrt(std::min(box.distance2(m_box), box_to.distance2(m_box_to)));
    const double tolerance = slack * m_tolerance * std::max(1.0, nearest / 2);
    const V3d normal = (after[1] - after[0]).cross(after[2] - after[0]).normalized();
    for (size_t k = 0; k < 3; ++k) {
        const V3d off = motion(before[k]) - after[k];
        const double rounding = slack * kFloatRounding * std::max(before[k].length(), after[k].length());
        // Corners round far away, but a plane must stay where it is seen.
        if (!(off.length() <= tolerance + (normal.length2() > 0.5 ? rounding : 0))
            || !(std::abs(off.dot(normal)) <= tolerance))
            return false;
    }
    return true;
}

// All that moves so and belongs to no body yet. Returns their number, and keeps the motion if there are some.
size_t PoseMotion::take(const RigidMotion& motion)
{
    const auto body = uint32_t(m_motions.size());
    size_t taken = 0;
    for (size_t i = 0; i < m_body.size(); ++i)
        if (m_body[i] == kSoft && fits(i, motion, 1)) {
            m_body[i] = body;
            ++taken;
        }
    m_soft -= int64_t(taken);
    if (taken > 0)
        m_motions.push_back(motion);
    return taken;
}

// The motion without a turn, if it fits all that `motion` fits.
RigidMotion PoseMotion::without_turn(const RigidMotion& motion, const std::vector<uint32_t>& some) const
{
    std::array<V3d, 3> before, after;
    V3d sum(0);
    double count = 0;
    for (const uint32_t i : some)
        if (fits(i, motion, 1)) {
            m_before.corners(i, before.data());
            m_after.corners(i, after.data());
            sum += after[0] - before[0];
            ++count;
        }
    const RigidMotion straight { Rotation(), sum / std::max(1.0, count) };
    for (const uint32_t i : some)
        if (fits(i, motion, 1) && !fits(i, straight, 1))
            return motion;
    return straight;
}

// The motion of few triangles close together is known roughly: the more agree with it, the better it is known.
bool PoseMotion::refine(RigidMotion& dst, size_t& fitting, const std::vector<uint32_t>& some) const
{
    for (const double slack : { 64.0, 8.0, 1.0, 1.0 }) {
        std::vector<V3d> from, to;
        std::array<V3d, 3> before, after;
        bool shaped = false;
        for (const uint32_t i : some) {
            if (!fits(i, dst, slack))
                continue;
            m_before.corners(i, before.data());
            m_after.corners(i, after.data());
            from.insert(from.end(), before.begin(), before.end());
            to.insert(to.end(), after.begin(), after.end());
            shaped = shaped || has_shape(before.data());
        }
        fitting = from.size() / 3;
        if (fitting < kFewest || !shaped)
            return false;
        dst = nearest_motion(from, to);
    }
    return true;
}

bool PoseMotion::find_body(RigidMotion& dst, const std::vector<uint32_t>& left) const
{
    std::vector<uint32_t> some;
    const size_t step = std::max<size_t>(1, left.size() / kAsked);
    for (size_t i = step / 2; i < left.size(); i += step)
        some.push_back(left[i]);
    size_t best = 0;
    for (uint32_t attempt = 0; attempt < kTries; ++attempt) {
        // A triangle, and two that the file has near it, mostly of the same part.
        const size_t seed = texel_hash(attempt, uint32_t(left.size()), 0).u % left.size();
        const size_t apart = std::min(left.size() / 2, size_t(1) << attempt % 8);
        std::vector<V3d> from, to;
        std::array<V3d, 3> before, after;
        bool shaped = false;
        std::vector<uint32_t> asked = some;
        for (const size_t i : { seed, (seed + apart) % left.size(), (seed + 2 * apart) % left.size() }) {
            m_before.corners(left[i], before.data());
            m_after.corners(left[i], after.data());
            from.insert(from.end(), before.begin(), before.end());
            to.insert(to.end(), after.begin(), after.end());
            shaped = shaped || has_shape(before.data());
            asked.push_back(left[i]);
        }
        RigidMotion motion = nearest_motion(from, to);
        size_t fitting = 0;
        if (!shaped || !refine(motion, fitting, asked) || fitting <= best)
            continue;
        best = fitting;
        dst = without_turn(motion, asked);
        if (best * 2 > asked.size())
            break;
    }
    return double(best) >= kSmallest * double(some.size());
}

Rotation PoseMotion::turn(uint32_t triangle) const
{
    if (m_body[triangle] != kSoft)
        return m_motions[m_body[triangle]].turn;
    std::array<V3d, 3> before, after;
    m_before.corners(triangle, before.data());
    m_after.corners(triangle, after.data());
    const V3d normal = surface_normal(m_base.mesh(), m_base.mesh().triangles[triangle]);
    const V3d normal_to = surface_normal(m_pose.mesh(), m_pose.mesh().triangles[triangle]);
    const V3d side = before[1] - before[0], side_to = after[1] - after[0];
    // In the plane of the triangle, also after rounding.
    return rotation_between(normal, (side - normal * side.dot(normal)).normalized(), normal_to,
                            (side_to - normal_to * side_to.dot(normal_to)).normalized());
}

} // namespace vmlight
