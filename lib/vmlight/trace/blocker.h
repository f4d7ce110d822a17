// SPDX-License-Identifier: Apache-2.0
/// Triangles that blocked a ray. In the shadow of a large triangle they block the next rays too, which need not be
/// traced.
#pragma once

#include <Imath/ImathVec.h>

#include <array>

namespace vmlight {

/// An opaque triangle, in the coordinates that Embree traces.
class Blocker
{
public:
    Blocker() = default;
    Blocker(const Imath::V3f& a, const Imath::V3f& b, const Imath::V3f& c);

    bool exists() const { return m_longest > 0; }

    /// Whether Embree is certain to find that the triangle blocks the ray within `length`: the ray passes inside all
    /// edges, and through the plane, by more than floats round on the way. False means unknown, not that the ray
    /// passes.
    /// @param direction    of unit length
    bool surely_blocks(const Imath::V3f& origin, const Imath::V3f& direction, float length) const;

private:
    std::array<Imath::V3d, 3> m_corners;
    double m_longest = 0; // of its edges
};

/// The last four triangles that blocked a ray, to try before tracing the next one. Only tried while traced rays are
/// being blocked, and while it saves enough of them: nearly all in the shadow of a wall, few in that of a fine mesh.
class RecentBlockers
{
public:
    /// Whether one of them surely blocks this ray.
    bool surely_block(const Imath::V3f& origin, const Imath::V3f& direction, float length);
    /// Whether trying has paid so far. If not, nothing is tried any more.
    bool pay() const { return m_credit > 0; }
    /// Call after tracing rays.
    /// @param blocker      what blocked one of them, if known
    /// @param any_blocked  whether any was blocked
    void remember(const Blocker& blocker, bool any_blocked);

private:
    static constexpr int kMost = 4;
    // A ray costs about as much as five attempts that fail.
    static constexpr int kMostCredit = 64, kCreditOfRay = 4;
    std::array<Blocker, kMost> m_latest; // first
    bool m_is_dark = false;
    int m_credit = kMostCredit;
};

} // namespace vmlight
