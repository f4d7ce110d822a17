// SPDX-License-Identifier: Apache-2.0
/// How a scene moves from one pose to another: which of its triangles move together as a rigid body.
#pragma once

#include <vmlight/trace/bake_scene.h>
#include <vmlight/trace/horizon.h>
#include <vmlight/trace/posed_parts.h>
#include <vmlight/trace/rigid_motion.h>

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

namespace vmlight {

/// The triangles of a scene in a pose: those of the baked mesh, then those of the parts. As they are traced, in units
/// of the scene of the first pose.
class PoseTriangles
{
public:
    /// @param side     of `parts`, that of the pose
    PoseTriangles(const BakeScene& pose, const BakeScene& first, const std::vector<PosedPart>& parts,
                  TracedTriangles PosedPart::*side);

    size_t count() const { return m_count; }
    size_t baked() const { return m_scene.mesh().triangles.size(); }
    /// The three corners of triangle number `triangle`, which must be traced in this pose.
    void corners(size_t triangle, Imath::V3d* dst) const;

private:
    const BakeScene& m_scene;
    std::vector<TracedTriangles> m_traced; // by part
    std::vector<size_t> m_first; // of each part, the baked mesh being the first
    double m_scale;
    size_t m_count;
};

class PoseMotion
{
public:
    /// Of triangles that move like no body, and of those that rays can meet in one pose only.
    static constexpr uint32_t kSoft = ~0u, kAway = ~1u;

    /// Both must outlive this.
    PoseMotion(const BakeScene& base, const BakeScene& pose);

    /// How the triangles that are traced differ in number from pose to pose, or "": all but fault() is then undefined.
    const std::string& fault() const { return m_fault; }

    /// Motions from the base's scene to that of the pose, both in units of the base's and around their own centres: at
    /// most kMotions bodies, what stands still first.
    static constexpr size_t kMotions = 16;
    const std::vector<RigidMotion>& motions() const { return m_motions; }
    /// The body of a triangle of the baked mesh, and of one that rays can meet (in the order of parts()).
    uint32_t body(uint32_t triangle) const { return m_body[triangle]; }
    uint32_t body_of_traced(size_t triangle) const { return m_body[m_before.baked() + triangle]; }

    const std::vector<PosedPart>& parts() const { return m_parts; }

    /// How a triangle of the baked mesh turns: with its body, or else on its own.
    Rotation turn(uint32_t triangle) const;

    /// Whether the first body stands still: to the bit, if both scenes have the same frame.
    bool stands_still() const { return m_stands_still; }
    /// Whether everything is one body.
    bool is_whole() const { return m_motions.size() == 1 && m_soft == 0 && m_away == 0; }
    /// Triangles that belong to no body.
    int64_t soft() const { return m_soft; }

    const BakeScene& base() const { return m_base; }
    const BakeScene& pose() const { return m_pose; }

private:
    bool fits(size_t triangle, const RigidMotion& motion, double slack) const;
    size_t take(const RigidMotion& motion);
    bool find_body(RigidMotion& dst, const std::vector<uint32_t>& left) const;
    RigidMotion without_turn(const RigidMotion& motion, const std::vector<uint32_t>& some) const;
    bool refine(RigidMotion& dst, size_t& fitting, const std::vector<uint32_t>& some) const;

    const BakeScene &m_base, &m_pose;
    std::string m_fault;
    const std::vector<PosedPart> m_parts;
    const PoseTriangles m_before, m_after;
    double m_tolerance = 0;
    std::vector<RigidMotion> m_motions;
    std::vector<uint32_t> m_body;
    int64_t m_soft = 0, m_away = 0;
    bool m_stands_still = false, m_is_same_scene = false;
    SceneBox m_box, m_box_to; // of the baked mesh, at most
};

} // namespace vmlight
