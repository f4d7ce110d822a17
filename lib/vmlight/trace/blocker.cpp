// SPDX-License-Identifier: Apache-2.0
#include <vmlight/trace/blocker.h>

#include <algorithm>

namespace vmlight {

using Imath::V3d;
using Imath::V3f;

namespace {

// Of distances, more than eight times what floats lose in the products by which Embree compares a ray with an edge.
constexpr double kRounding = 1.0 / (1 << 19);

} // namespace

Blocker::Blocker(const V3f& a, const V3f& b, const V3f& c)
    : m_corners { V3d(a), V3d(b), V3d(c) }
    , m_longest(std::max({ (b - a).length(), (c - b).length(), (a - c).length() }))
{
}

bool Blocker::surely_blocks(const V3f& origin, const V3f& direction, float length) const
{
    const V3d from(origin), along(direction);
    const V3d a = m_corners[0] - from, b = m_corners[1] - from, c = m_corners[2] - from;
    // Twice the areas, seen along the ray, of what it and each edge span.
    const V3d edge = b.cross(c);
    const double first = along.dot(edge), side = first > 0 ? 1 : -1;
    const double second = along.dot(c.cross(a));
    if (!(side * second > 0)) // most
        return false;
    const double third = along.dot(a.cross(b));
    if (!(side * third > 0))
        return false;
    const double least = (a.length() + m_longest) * m_longest * kRounding;
    if (!(side * first > least && side * second > least && side * third > least))
        return false;
    const double ahead = side * a.dot(edge), area = side * (first + second + third);
    return ahead > least * m_longest && ahead < area * double(length) * (1 - kRounding) - least * m_longest;
}

bool RecentBlockers::surely_block(const V3f& origin, const V3f& direction, float length)
{
    if (!m_is_dark || !pay())
        return false;
    for (auto blocker = m_latest.begin(); blocker != m_latest.end() && blocker->exists(); ++blocker)
        if (blocker->surely_blocks(origin, direction, length)) {
            std::rotate(m_latest.begin(), blocker, blocker + 1);
            m_credit = std::min(m_credit + kCreditOfRay, kMostCredit);
            return true;
        }
    --m_credit;
    return false;
}

void RecentBlockers::remember(const Blocker& blocker, bool any_blocked)
{
    m_is_dark = any_blocked;
    if (!blocker.exists())
        return;
    std::rotate(m_latest.begin(), m_latest.end() - 1, m_latest.end());
    m_latest.front() = blocker;
}

} // namespace vmlight
