// SPDX-License-Identifier: Apache-2.0
#include <vmlight/reference/bounce_paths.h>

#include <vmlight/math/latlong.h>
#include <vmlight/math/sampling.h>

#include <algorithm>
#include <cmath>

namespace vmlight {

using Imath::V3d;
using Imath::V3f;
using latlong::pi;

void BouncePaths::add(const SurfacePoint& point, const V3d& direction, V3d& dst, ReferenceRandom& random)
{
    if (!(direction.dot(V3d(point.normal)) > 0 && direction.dot(V3d(point.geometric_normal)) > 0))
        return;
    m_directions[size_t(m_waiting)] = V3f(direction);
    m_owners[size_t(m_waiting)] = &dst;
    if (++m_waiting == kPacketSize)
        flush(point, random);
}

void BouncePaths::flush(const SurfacePoint& point, ReferenceRandom& random)
{
    if (m_waiting == 0)
        return;
    std::array<V3f, kPacketSize> origins;
    std::array<float, kPacketSize> lengths;
    std::array<NearestHit, kPacketSize> hits;
    const double height = m_ground.exists() ? std::max(0.0, m_ground.height_of(point)) : 0;
    for (size_t i = 0; i < size_t(m_waiting); ++i) {
        const float y = m_directions[i].y;
        origins[i] = point.origin;
        // The ground ends rays, and is black.
        lengths[i] = y < m_ground.lowest_ray(point) ? (y < 0 ? float(height / -double(y)) : 0) : m_length;
    }
    m_scene.occluder().find_nearest(origins.data(), m_directions.data(), lengths.data(), m_waiting, hits.data());
    Points met;
    std::array<V3d*, kPacketSize> owners {};
    int count = 0;
    for (size_t i = 0; i < size_t(m_waiting); ++i)
        if (hits[i].exists() && meet(met[size_t(count)], point, m_directions[i], hits[i]))
            owners[size_t(count++)] = m_owners[i];
    m_waiting = 0;
    if (count > 0)
        light(met, owners, count, random);
}

// The front of the mesh is smooth, as its texels are.
bool BouncePaths::meet(SurfacePoint& dst, const SurfacePoint& from, const V3f& direction, const NearestHit& hit)
{
    if (m_scene.casters()[hit.mesh] == BakeScene::kWhole && &m_scene.whole() == &m_scene.mesh()) {
        dst = m_surface.at(hit.triangle, hit.u, hit.v);
        if (dst.geometric_normal.dot(direction) < 0)
            return true;
    }
    const V3f normal = facing_normal(hit, direction);
    dst = flat_surface(from.origin + direction * hit.distance, normal);
    return normal != V3f(0);
}

void BouncePaths::light(const Points& given, const std::array<V3d*, kPacketSize>& owners, int count,
                        ReferenceRandom& random)
{
    Points points = given;
    adjust_ray_origins(points.data(), count, m_scene.occluder());
    std::array<V3f, kPacketSize> origins, directions;
    std::array<V3d, kPacketSize> values;
    for (const bool is_bright : { false, true }) {
        for (size_t i = 0; i < size_t(count); ++i) {
            const SurfacePoint& point = points[i];
            const double u = random.next(), v = random.next();
            EnvironmentSample sample;
            V3d direction;
            if (is_bright) {
                sample = m_light.sample(u, v);
                direction = rotate(m_to_object, sample.direction);
            } else {
                const TangentFrame frame(point.normal);
                const double radius = std::sqrt(u), angle = 2 * pi * v, z = std::sqrt(std::max(0.0, 1 - u));
                direction = V3d(frame.tangent) * (radius * std::cos(angle))
                    + V3d(frame.bitangent) * (radius * std::sin(angle)) + V3d(frame.normal) * z;
                sample = m_light.at(rotate(m_to_environment, direction));
            }
            const double cosine = direction.dot(V3d(point.normal));
            const bool counts = cosine > 0 && direction.dot(V3d(point.geometric_normal)) > 0
                && float(direction.y) >= m_ground.lowest_ray(point);
            const double above = 0.5 * (1 + double(point.normal.dot(point.geometric_normal)));
            // The balance heuristic, as for the light of the sky.
            values[i]
                = counts ? V3d(sample.radiance) * (m_albedo / above * cosine / (cosine + pi * sample.density)) : V3d(0);
            origins[i] = point.origin;
            directions[i] = V3f(direction);
        }
        for (size_t i = size_t(count); i < kPacketSize; ++i) { // unused lanes must hold valid numbers too
            origins[i] = origins[0];
            directions[i] = directions[0];
        }
        const uint8_t blocked = m_scene.occluder().find_blocked(origins.data(), directions.data(), count, m_length);
        for (size_t i = 0; i < size_t(count); ++i)
            *owners[i] += blocked >> i & 1 ? V3d(0) : values[i];
    }
}

} // namespace vmlight
