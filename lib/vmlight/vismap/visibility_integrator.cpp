// SPDX-License-Identifier: Apache-2.0
#include <vmlight/vismap/visibility_integrator.h>

#include <vmlight/base/work_counts.h>
#include <vmlight/math/longest_direction.h>

#include <algorithm>
#include <array>
#include <bitset>
#include <cmath>
#include <numeric>

namespace vmlight {

using Imath::V3d;
using Imath::V3f;

namespace {

// Of the length of a float normal.
constexpr double kRounding = 1e-6;

// Rays in each lane, over all packets.
using LaneCounts = std::array<int, kPacketSize>;

LaneCounts count_lanes(const std::vector<uint8_t>& packets)
{
    constexpr uint64_t kOnes = 0x0101010101010101, kDiagonal = 0x8040201008040201;
    constexpr size_t kBlock = 255; // that a byte can count
    LaneCounts counts {};
    for (size_t first = 0; first < packets.size(); first += kBlock) {
        uint64_t sums = 0; // byte k has lane k
        for (size_t i = first; i < std::min(packets.size(), first + kBlock); ++i)
            sums += ((packets[i] * kOnes & kDiagonal) + 0x7f * kOnes) >> 7 & kOnes;
        for (size_t lane = 0; lane < kPacketSize; ++lane)
            counts[lane] += int(sums >> 8 * lane & 0xff);
    }
    return counts;
}

} // namespace

double lane_scatter(const std::vector<uint8_t>& traced, const std::vector<uint8_t>& open)
{
    const LaneCounts all = count_lanes(traced), unblocked = count_lanes(open);
    const double rays = std::accumulate(all.begin(), all.end(), 0);
    const double share = std::accumulate(unblocked.begin(), unblocked.end(), 0) / std::max(1.0, rays);
    double squares = 0, lanes = 0;
    for (size_t lane = 0; lane < kPacketSize; ++lane) {
        const double excess = unblocked[lane] - share * all[lane];
        squares += excess * excess;
        lanes += all[lane] > 0;
    }
    return lanes > 1 ? std::sqrt(squares * lanes / (lanes - 1)) / rays : 0;
}

double independent_error(int64_t open, int64_t traced)
{
    if (traced < 2)
        return 0;
    const double share = double(open) / double(traced);
    return std::sqrt(share * (1 - share) / double(traced));
}

VisibilityIntegrator::~VisibilityIntegrator()
{
    work_counts().directions_below_ground += m_below_ground;
}

template <class Test> void VisibilityIntegrator::take_out(const Test& is_out)
{
    for (int packet = 0; packet < m_fan.packets; ++packet)
        for (int lane = 0; lane < kPacketSize; ++lane) {
            const int ray = packet * kPacketSize + lane;
            if (is_out(V3f(m_fan.x[ray], m_fan.y[ray], m_fan.z[ray])))
                m_fan.lanes[size_t(packet)] &= uint8_t(~(1 << lane));
        }
}

Visibility VisibilityIntegrator::integrate(SurfacePoint point, Point32 texel, bool open, float* basis,
                                           const RayMemory& memory)
{
    m_memory = memory;
    const bool is_mapped = point.normal != point.mesh_normal;
    m_pattern.directions(m_fan, TangentFrame(point.normal), is_mapped ? point.normal : point.geometric_normal, texel);
    if (is_mapped)
        take_out(
            [&](const V3f& ray) { return ray.dot(point.geometric_normal) <= 0 && ray.dot(point.mesh_normal) > 0; });
    DirectionSums all = sum_directions(m_fan, point.normal);
    if (all.rays == 0) {
        // Few rays, and all of them below the surface: around the geometric normal none is.
        point.normal = point.geometric_normal;
        m_pattern.directions(m_fan, TangentFrame(point.normal), point.geometric_normal, texel);
        all = sum_directions(m_fan, point.normal);
    }
    if (all.rays == 0) {
        // Few rays of the measure `uniform`, all so close to the horizon that they round to below it.
        m_fan.x[0] = point.normal.x, m_fan.y[0] = point.normal.y, m_fan.z[0] = point.normal.z;
        m_fan.lanes[0] = 1;
        all = sum_directions(m_fan, point.normal);
    }
    basis = m_basis ? basis : nullptr;
    if (basis || m_wants_error)
        m_traced = m_fan.lanes;
    if (is_mapped)
        take_out([&](const V3f& ray) { return ray.dot(point.geometric_normal) <= 0; });
    // Those that the surface itself does not block.
    const DirectionSums above = is_mapped ? sum_directions(m_fan, point.normal) : all;

    Visibility result;
    if (m_ground.exists()) {
        trace_over_ground(result, point, all, open, is_mapped);
    } else {
        trace(result, point, all, above, open);
    }
    // Chance, and above all rays that are not traced because they are below the facet, make of the rest what no
    // surface can see: too narrow a part of the sky, and so too bright a light under a sun.
    const double length = result.direction.length(), longest = longest_direction(result.visibility);
    double narrowed = 1;
    if (length > std::min(result.visibility, longest * (1 + kRounding))) {
        narrowed = longest / length;
        result.direction *= narrowed;
    }
    if (basis)
        m_basis->project({ m_fan, m_traced, all.rays == m_pattern.count(), point.normal, point.geometric_normal,
                           result.visibility, narrowed },
                         basis);
    return result;
}

void VisibilityIntegrator::trace_unknown(const SurfacePoint& point)
{
    MovedBoxes::Near near;
    m_memory.moved->find_near(near, point, m_length);
    m_kept.resize(m_fan.lanes.size());
    int64_t unknown = 0;
    for (int packet = 0; packet < m_fan.packets; ++packet) {
        uint8_t& lanes = m_fan.lanes[size_t(packet)];
        const uint8_t may = lanes & MovedBoxes::may_meet(near, m_fan, packet, point.origin, m_length);
        m_kept[size_t(packet)] = uint8_t(lanes & ~may & m_memory.known[packet]);
        lanes = may;
        unknown += int64_t(std::bitset<kPacketSize>(may).count());
    }
    if (unknown > 0)
        m_occluder.clear_blocked(m_fan, point.origin, m_length, point.is_near);
    for (size_t packet = 0; packet < m_kept.size(); ++packet)
        m_fan.lanes[packet] |= m_kept[packet];
    m_rays += unknown;
}

double VisibilityIntegrator::error_of(const std::vector<uint8_t>& traced) const
{
    return m_is_reconstructed ? independent_error(count_rays(m_fan), count_rays(traced))
                              : lane_scatter(traced, m_fan.lanes);
}

DirectionSums VisibilityIntegrator::trace(Visibility& dst, const SurfacePoint& point, const DirectionSums& all,
                                          const DirectionSums& above, bool open)
{
    if (!open && above.rays > 0 && m_memory.known) {
        trace_unknown(point);
    } else if (!open && above.rays > 0) {
        m_rays += above.rays;
        m_occluder.clear_blocked(m_fan, point.origin, m_length, point.is_near);
    }
    if (m_memory.record)
        std::copy(m_fan.lanes.begin(), m_fan.lanes.end(), m_memory.record);
    const DirectionSums seen = open ? above : sum_directions(m_fan, point.normal);
    dst.visibility = double(seen.rays) / double(all.rays);
    dst.direction = mean_direction(seen, all, point.normal);
    if (m_wants_error)
        dst.error = error_of(m_traced);
    return seen;
}

void VisibilityIntegrator::trace_over_ground(Visibility& dst, const SurfacePoint& point, const DirectionSums& all,
                                             bool open, bool is_mapped)
{
    const int64_t before = count_rays(m_fan);
    m_ground.clear_blocked(m_fan, point);
    const DirectionSums above = sum_directions(m_fan, point.normal);
    m_below_ground += before - above.rays;
    // Exact where every direction of the hemisphere counts; of the rest, rays say how much other things block.
    const bool exact = !is_mapped && all.rays == m_pattern.count() && m_params.measure == "cosine"
        && m_ground.hides_lower_half(point);
    if (exact && m_wants_error)
        m_traced_above = m_fan.lanes;
    const DirectionSums seen = trace(dst, point, all, above, open);
    if (!exact)
        return;
    // A ratio: 1 exactly where the ground alone occludes, 0 where nothing is visible. Without a ray above the ground
    // nothing is known of other things; what is visible is less than a ray's share then.
    const GroundView view = ground_view(V3d(point.normal));
    const double share = above.rays > 0 ? double(seen.rays) / double(above.rays) : 1;
    const double rays = double(all.rays);
    dst.visibility = view.visibility * share;
    dst.direction = seen.sum / rays + (view.direction - above.sum / rays) * share;
    if (m_wants_error)
        dst.error = view.visibility * error_of(m_traced_above);
}

V3d VisibilityIntegrator::mean_direction(const DirectionSums& seen, const DirectionSums& all,
                                         const Imath::V3f& normal) const
{
    if (seen.rays == 0)
        return V3d(0);
    const double visibility = double(seen.rays) / double(all.rays);
    if (m_params.measure == "uniform")
        return seen.weight > 0 ? seen.weighted_sum * (visibility / seen.weight) : V3d(0);
    const V3d direction = seen.sum / double(all.rays);
    if (all.rays != m_pattern.count())
        return direction;
    // A control variate: the mean of all directions is known, (2/3) n, and the rays' error in it is removed from the
    // visible part in proportion. Exact where all or nothing is visible. Measured change of the error of B at 16, 64,
    // 256 rays of `fibonacci`: wall -9 -12 -6 %, disc overhead -17 -25 -23 %, ball above -12 -14 -6 %, low wall
    // -10 -15 -5 %, corner -3 -4 -2 %, streets between boxes within 1 %, floor of a pit +9 +12 +8 %; `halton` gains
    // more, `sobol` less.
    return direction + (V3d(normal) * (2.0 / 3) - all.sum / double(all.rays)) * visibility;
}

} // namespace vmlight
