// SPDX-License-Identifier: Apache-2.0
#include <vmlight/vismap/disc_look.h>

#include <vmlight/math/sampling.h>

namespace vmlight {

using Imath::V3d;
using Imath::V3f;

DiscLook::DiscLook(const Occluder& occluder, const Disc& disc, const DiscSamples& samples, float length, int seed,
                   const GroundPlane& ground, LookedTile& looked, bool tries_blockers)
    : m_occluder(occluder)
    , m_samples(samples)
    , m_horizon(disc, ground)
    , m_mean_length(disc_mean_length(disc.half_angle))
    , m_length(length)
    , m_seed(uint32_t(seed))
    , m_looked(looked)
    , m_tries_blockers(tries_blockers)
{
}

DiscHeight DiscLook::add(const SurfacePoint& point, bool is_open, int left, int top, int x, int y, float* dst)
{
    const DiscHeight height = m_horizon.height(point);
    if (height != DiscHeight::whole)
        return height;
    const uint32_t hash = texel_hash(uint32_t(left + x), uint32_t(top + y), m_seed).u;
    const V3f& direction = m_samples.probe(hash / 4, hash % 4 != 0); // three of four at the rim
    const double facing = V3d(point.normal).dot(m_horizon.direction);
    const auto value = float(facing * m_mean_length / DiscHorizon::counted(point));
    if (is_open && direction.dot(point.geometric_normal) > 0) { // in floats too, as Horizon asks
        *dst = value;
        m_looked.set(x, y, true);
        return height;
    }
    if (m_blockers.surely_block(point.origin, direction, m_length)) {
        *dst = 0;
        m_looked.set(x, y, false);
        return height;
    }
    m_origins[size_t(m_count)] = point.origin;
    m_directions[size_t(m_count)] = direction;
    m_waiting[size_t(m_count)] = { dst, value, uint8_t(x), uint8_t(y) };
    m_is_near = m_is_near || point.is_near;
    if (++m_count == kPacketSize)
        flush();
    return height;
}

void DiscLook::flush()
{
    if (m_count == 0)
        return;
    for (int i = m_count; i < kPacketSize; ++i) { // unused lanes must hold valid numbers too
        m_origins[size_t(i)] = m_origins[0];
        m_directions[size_t(i)] = m_directions[0];
    }
    Blocker blocker;
    const bool tries = m_tries_blockers && m_blockers.pay();
    const uint8_t blocked = m_occluder.find_blocked(m_origins.data(), m_directions.data(), m_count, m_length, m_is_near,
                                                    tries ? &blocker : nullptr);
    m_blockers.remember(blocker, tries && blocked != 0);
    for (int i = 0; i < m_count; ++i) {
        const Waiting& texel = m_waiting[size_t(i)];
        const bool is_seen = !(blocked >> i & 1);
        *texel.dst = is_seen ? texel.value : 0;
        m_looked.set(texel.x, texel.y, is_seen);
    }
    m_rays += m_count;
    m_count = 0;
    m_is_near = false;
}

} // namespace vmlight
