// SPDX-License-Identifier: Apache-2.0
/// Triangles that have blocked rays, which block most of the rays that come after: found out without a ray.
#pragma once

#include <Imath/ImathVec.h>

#include <array>

namespace vmlight {

/// A triangle, as it is traced, that lets no light pass.
class Blocker
{
public:
    Blocker() = default;
    Blocker(const Imath::V3f& a, const Imath::V3f& b, const Imath::V3f& c);

    bool exists() const { return m_longest > 0; }

    /// Whether Embree is sure to find that the triangle blocks the ray, which has unit length, within `length`: the ray
    /// passes all of its edges, and its plane, at more than the rounding of floats on the way to it. False does not
    /// mean that it passes.
    bool surely_blocks(const Imath::V3f& origin, const Imath::V3f& direction, float length) const;

private:
    std::array<Imath::V3d, 3> m_corners;
    double m_longest = 0; // of its edges
};

/// The last four that blocked a ray, tried before a ray is traced: as long as rays that are traced are blocked, and
/// while that spares enough of them. In the shadow of a wall nearly all are spared, in that of a fine mesh few.
class RecentBlockers
{
public:
    /// Whether one of them surely blocks this ray.
    bool surely_block(const Imath::V3f& origin, const Imath::V3f& direction, float length);
    /// Whether trying has paid so far. If not, nothing is tried, and need not be remembered.
    bool pay() const { return m_credit > 0; }
    /// After rays were traced: what blocked one of them, if it is known; whether any was blocked.
    void remember(const Blocker& blocker, bool any_blocked);

private:
    static constexpr int kMost = 4;
    // A ray costs about as much as trying in vain for five.
    static constexpr int kMostCredit = 64, kCreditOfRay = 4;
    std::array<Blocker, kMost> m_latest; // first
    bool m_is_dark = false;
    int m_credit = kMostCredit;
};

} // namespace vmlight
