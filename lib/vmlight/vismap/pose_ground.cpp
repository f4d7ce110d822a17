// SPDX-License-Identifier: Apache-2.0
#include <vmlight/vismap/pose_ground.h>

#include <vmlight/trace/facet.h>
#include <vmlight/vismap/ground_of.h>
#include <vmlight/vismap/pose_proof.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace vmlight {

using Imath::V3d;

namespace {

constexpr double kPi = 3.14159265358979323846;

// Heights of a triangle above the ground of its pose, in the units of its scene.
struct Heights
{
    Heights(const Facet& facet, const GroundPlane& ground)
        : low(std::numeric_limits<double>::infinity())
    {
        for (size_t k = 0; k < 3; ++k) {
            corner[k] = facet.corners[k].y - ground.height();
            low = std::min(low, corner[k]);
            high = std::max(high, corner[k]);
        }
    }
    // Beyond doubt: a point within rounds by less than half of what GroundPlane takes for a point on the plane.
    bool is_above() const { return low >= -kNearRayOffset / 2; }
    bool is_below() const { return high <= -2 * kNearRayOffset; }

    std::array<double, 3> corner {};
    double low, high = -std::numeric_limits<double>::infinity();
};

// A bound of the share of the rays between two horizons, `tilt` radians apart, around a normal whose sine to the
// vertical is `sine`. They are two lunes with 4 tilt of solid angle, at most half of it above the surface.
double share_between(double tilt, double sine, bool by_cosine)
{
    const double in_lunes = tilt / kPi;
    return by_cosine ? std::min(tilt / 2, 2 * in_lunes * std::min(1.0, sine + tilt)) : in_lunes;
}

} // namespace

PoseGround::PoseGround(const PoseMotion& motion, const VismapParams& params, double error)
{
    if (!params.ground)
        return;
    const BakeScene &base = motion.base(), &pose = motion.pose();
    const GroundPlane before = ground_of(base, params), after = ground_of(pose, params);
    const double reach_before = params.max_distance * base.frame().scale;
    const double reach_after = params.max_distance * pose.frame().scale;
    const V3d up(0, 1, 0);
    m_keeps.assign(base.mesh().triangles.size(), none);
    for (uint32_t t = 0; t < m_keeps.size(); ++t) {
        const Facet facet(base, t), facet_to(pose, t);
        const Heights heights(facet, before), heights_to(facet_to, after);
        if (heights.is_below() && heights_to.is_below()) {
            m_keeps[t] = all;
            continue;
        }
        // Of the direction of the lowest ray that the ground leaves.
        double change = 0;
        for (size_t k = 0; k < 3; ++k)
            change = std::max(change, std::abs(heights.corner[k] / reach_before - heights_to.corner[k] / reach_after));
        const double tilt = (rotate(motion.turn(t), up) - up).length();
        const double upright = std::min(std::abs(facet.normal.y), std::abs(facet_to.normal.y));
        change += share_between(tilt, std::sqrt(std::max(0.0, 1 - upright * upright)), params.measure == "cosine");
        if (change <= std::max(error, kSameNormal))
            m_keeps[t] = heights.is_above() && heights_to.is_above() ? all : by_side;
    }
}

bool PoseGround::keeps_all() const
{
    return std::all_of(m_keeps.begin(), m_keeps.end(), [](uint8_t keeps) { return keeps == all; });
}

GroundSides::GroundSides(const PoseMotion& motion, const VismapParams& params)
    : m_ground_before(ground_of(motion.base(), params))
    , m_ground_after(ground_of(motion.pose(), params))
    , m_before(motion.base().mesh(), motion.base().frame())
    , m_after(motion.pose().mesh(), motion.pose().frame())
{
}

bool GroundSides::are_same(uint32_t triangle, float weight1, float weight2)
{
    const bool below = m_ground_before.height_of(m_before.at(triangle, weight1, weight2)) < 0;
    return below == (m_ground_after.height_of(m_after.at(triangle, weight1, weight2)) < 0);
}

bool is_same_ground(const BakeScene& base, const BakeScene& pose, const VismapParams& params)
{
    const SceneFrame &before = base.frame(), &after = pose.frame();
    return !params.ground
        || (before.scale == after.scale && before.centre == after.centre
            && ground_of(base, params).height() == ground_of(pose, params).height());
}

} // namespace vmlight
