// SPDX-License-Identifier: Apache-2.0
#include <vmlight/vismap/bounce_rays.h>

#include <algorithm>
#include <cmath>

namespace vmlight {

using Imath::V3f;

namespace {

// Of directions whose errors are independent of those of V.
constexpr uint32_t kOtherSeed = 0x9e3779b9u;

} // namespace

BounceRays::BounceRays(const MapPoints& map, const MapPatches& patches, const SamplePattern& pattern,
                       const SamplePattern& bake_pattern, const GroundPlane& ground, bool ground_reflects)
    : m_map(map)
    , m_patches(patches)
    , m_pattern(pattern)
    , m_bake_pattern(bake_pattern)
    , m_ground(ground)
    , m_ground_reflects(ground_reflects)
    , m_length(float(map.params().max_distance * map.scene().frame().scale))
    , m_fan(pattern.count())
    , m_bake_fan(bake_pattern.count())
{
}

BounceRays::Count BounceRays::trace(const SurfacePoint& point, size_t texel, int x, int y, std::vector<uint32_t>& met,
                                    int round)
{
    const bool is_own = round != kRaysOfBake;
    const SamplePattern& pattern = is_own ? m_pattern : m_bake_pattern;
    RayFan& fan = is_own ? m_fan : m_bake_fan;
    const auto seed = uint32_t(m_map.params().seed);
    const Point32 shift = pattern.texel(x, y, is_own ? seed ^ (kOtherSeed + uint32_t(round)) : seed);
    const bool is_mapped = point.normal != point.mesh_normal;
    pattern.directions(fan, TangentFrame(point.normal), is_mapped ? point.normal : point.geometric_normal, shift);
    const float lowest = m_ground.lowest_ray(point);
    const double height = m_ground.exists() ? m_ground.height_of(point) : 0;
    Count count;
    for (int ray = 0; ray < pattern.count(); ++ray) {
        if (!(fan.lanes[size_t(ray / kPacketSize)] >> ray % kPacketSize & 1))
            continue;
        const V3f direction(fan.x[ray], fan.y[ray], fan.z[ray]);
        const bool is_below = is_mapped && direction.dot(point.geometric_normal) <= 0;
        if (is_below && direction.dot(point.mesh_normal) > 0) // an error of the mesh's normal: as in the bake
            continue;
        ++count.all;
        const bool ends_on_ground = direction.y < lowest;
        if (is_below || (ends_on_ground && !(height > 0))) {
            ++count.blocked;
            if (is_below) // the surface meets itself
                met.push_back(m_patches.of_texel(texel));
            else if (m_ground_reflects && height == 0 && point.geometric_normal.y >= 0) // else they touch: no light
                meet_ground(point.near_origin, 0, met);
            continue;
        }
        m_origins[size_t(m_waiting)] = point.origin;
        m_directions[size_t(m_waiting)] = direction;
        m_lengths[size_t(m_waiting)] = ends_on_ground ? float(height / -double(direction.y)) : m_length;
        m_ends_on_ground[size_t(m_waiting)] = ends_on_ground;
        if (++m_waiting == kPacketSize)
            flush(point, count, met);
    }
    flush(point, count, met);
    return count;
}

void BounceRays::flush(const SurfacePoint& point, Count& count, std::vector<uint32_t>& met)
{
    if (m_waiting == 0)
        return;
    m_map.scene().occluder().find_nearest(m_origins.data(), m_directions.data(), m_lengths.data(), m_waiting,
                                          m_hits.data());
    m_rays += m_waiting;
    for (size_t i = 0; i < size_t(m_waiting); ++i) {
        const bool hits = m_hits[i].exists();
        count.blocked += hits || m_ends_on_ground[i];
        if (hits)
            meet(point, m_directions[i], m_hits[i], met);
        else if (m_ends_on_ground[i] && m_ground_reflects)
            meet_ground(point.origin + m_directions[i] * m_lengths[i], m_lengths[i], met);
    }
    m_waiting = 0;
}

// Rays start off the surface, and floats round: what is below the plane would see nothing.
void BounceRays::meet_ground(const V3f& position, float distance, std::vector<uint32_t>& met)
{
    const V3f on_plane(position.x, float(m_ground.height()), position.z);
    met.push_back(kCell | m_cells.add({}, on_plane, V3f(0, 1, 0), distance));
}

void BounceRays::meet(const SurfacePoint& point, const V3f& direction, const NearestHit& hit,
                      std::vector<uint32_t>& met)
{
    const BakeScene& scene = m_map.scene();
    const int caster = scene.casters()[hit.mesh];
    if (caster == BakeScene::kWhole) {
        const Mesh& mesh = scene.whole();
        const bool is_front = surface_normal(mesh, mesh.triangles[hit.triangle]).dot(Imath::V3d(direction)) < 0;
        const uint32_t patch = is_front ? m_patches.find(hit.triangle, hit.u, hit.v) : MapPatches::kNone;
        if (patch != MapPatches::kNone) {
            met.push_back(patch);
            return;
        }
    }
    const V3f normal = facing_normal(hit, direction);
    if (normal == V3f(0)) // no area, and so no light
        return;
    const uint32_t triangle = caster == BakeScene::kWhole ? m_patches.baked_triangle(hit.triangle) : hit.triangle;
    met.push_back(kCell
                  | m_cells.add({ caster, triangle, hit.u, hit.v }, point.origin + direction * hit.distance, normal,
                                hit.distance));
}

} // namespace vmlight
