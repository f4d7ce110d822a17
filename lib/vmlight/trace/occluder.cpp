// SPDX-License-Identifier: Apache-2.0
#include <vmlight/trace/occluder.h>

#include <vmlight/trace/blocker.h>
#include <vmlight/trace/embree_scene.h>
#include <vmlight/trace/exact_hit.h>
#include <vmlight/trace/fan_query.h>
#include <vmlight/trace/surface.h>

#include <algorithm>
#include <array>

namespace vmlight {

using Imath::V3d;
using Imath::V3f;

namespace {

// Chance depends on a mesh's number: those of distinct meshes are beyond those of meshes.
constexpr size_t kNextDistinct = 1 << 16;

// Embree's filter of hits: keep those ahead of the ray's origin, computed in double from the same floats.
void reject_hits_behind_origin(const RTCFilterFunctionNArguments* arguments)
{
    const auto& buffers = *static_cast<const embree::Buffers*>(arguments->geometryUserPtr);
    for (unsigned i = 0; i < arguments->N; ++i) {
        if (!arguments->valid[i])
            continue;
        if (!buffers.triangles) // a strand's ribbon faces the ray
            continue;
        const embree::ExactHit hit(buffers, *arguments, i);
        const V3d& a = hit.corners[0];
        const V3d normal = (hit.corners[1] - a).cross(hit.corners[2] - a);
        if (!((a - V3d(hit.origin)).dot(normal) / V3d(hit.direction).dot(normal) > 0))
            arguments->valid[i] = 0;
    }
}

// Embree's filter of hits that notes one of them.
void note_blocker(const RTCFilterFunctionNArguments* arguments)
{
    const auto& buffers = *static_cast<const embree::Buffers*>(arguments->geometryUserPtr);
    if (!buffers.triangles || buffers.cutouts)
        return;
    const unsigned lanes = embree::valid_lanes(arguments->valid, arguments->N);
    if (!lanes)
        return;
    static_cast<embree::QueryContext*>(arguments->context)->blocker
        = { &buffers, RTCHitN_primID(arguments->hit, arguments->N, embree::first_lane(lanes)) };
}

void reject_and_note(const RTCFilterFunctionNArguments* arguments)
{
    reject_hits_behind_origin(arguments);
    note_blocker(arguments);
}

// As Occluder::find_blocked(), of the rays in `lanes`, in a scene with instances. What is near may lie on the wrong
// side of the origin in the space of an instance: rays start earlier, and the filter says what is ahead of their
// origins.
uint8_t find_blocked_by_instances(const embree::Scene& scene, embree::Query& query, const V3f* origins,
                                  const V3f* directions, uint8_t lanes, float length, bool is_near)
{
    const float back = is_near ? float(kNearRayOffset) : 0;
    embree::SceneRays asked;
    asked.placements = &scene.placements();
    query.set_scene_rays(&asked);
    RTCRay8 rays;
    alignas(32) int valid[kPacketSize];
    for (int lane = 0; lane < kPacketSize; ++lane) {
        asked.origins[lane] = origins[lane];
        asked.directions[lane] = directions[lane];
        const V3f start = origins[lane] - directions[lane] * back;
        rays.org_x[lane] = start.x, rays.org_y[lane] = start.y, rays.org_z[lane] = start.z;
        rays.dir_x[lane] = directions[lane].x, rays.dir_y[lane] = directions[lane].y,
        rays.dir_z[lane] = directions[lane].z;
        rays.tfar[lane] = length + back;
        embree::prepare_lane(rays, lane);
        valid[lane] = lanes >> lane & 1 ? -1 : 0;
    }
    query.occluded8(valid, scene.handle(), rays);
    query.set_scene_rays(nullptr);
    uint8_t blocked = 0;
    for (int lane = 0; lane < kPacketSize; ++lane)
        blocked |= uint8_t(valid[lane] && !(rays.tfar[lane] >= 0)) << lane;
    return blocked;
}

} // namespace

Occluder::Occluder() = default;
Occluder::~Occluder() = default;

bool Occluder::build(const std::vector<const Mesh*>& meshes, const SceneFrame& frame, int nthreads, std::string& error,
                     CutoutMode mode, const StepListener& at_step, InstanceMode instances, const Mesh* lasting)
{
    std::vector<const Mesh*> traced;
    std::vector<embree::PlacedMeshes> placed;
    const auto add_cutouts = [&](const Mesh& mesh, size_t number) {
        if (mesh.opacity)
            begin_step(at_step, "sort cut-outs");
        auto cutouts = Cutouts::make(mesh, uint32_t(number), nthreads, mode);
        if (cutouts)
            m_counts.add(cutouts->counts());
        return cutouts;
    };
    for (size_t i = 0; i < meshes.size(); ++i) {
        if (!meshes[i])
            continue;
        traced.push_back(meshes[i]);
        m_cutouts.push_back(add_cutouts(*meshes[i], i));
        if (!meshes[i]->instances)
            continue;
        placed.push_back({ traced.size() - 1, meshes[i]->instances.get(), {}, instances });
        for (size_t k = 0; k < meshes[i]->instances->meshes.size(); ++k) {
            m_distinct_cutouts.push_back(add_cutouts(meshes[i]->instances->meshes[k], i + (k + 1) * kNextDistinct));
            placed.back().cutouts.push_back(m_distinct_cutouts.back().get());
        }
    }
    begin_step(at_step, "build");
    m_scene = embree::Scene::build(traced, frame, nthreads, error, m_cutouts, placed, lasting);
    if (!m_scene)
        return false;
    m_instances = m_scene->instances();
    return true;
}

bool Occluder::has_strands() const
{
    return m_scene->has_curves();
}

bool Occluder::has_cutouts_of(size_t mesh, const Occluder& other, size_t its_mesh) const
{
    const auto &a = m_cutouts[mesh], &b = other.m_cutouts[its_mesh];
    return a && b ? *a == *b : !a && !b;
}

void Occluder::count(const CutoutWork& work) const
{
    if (work.hits == 0)
        return;
    m_hits += work.hits;
    m_lookups += work.lookups;
}

std::vector<TracedTriangles> Occluder::triangles() const
{
    std::vector<TracedTriangles> all;
    for (const embree::Buffers& mesh : m_scene->buffers())
        all.push_back({ mesh.vertices, mesh.triangles, mesh.triangle_count, mesh.mesh });
    return all;
}

void Occluder::clear_blocked(RayFan& fan, const V3f& origin, float length, bool is_near) const
{
    const embree::FlushDenormals flush;
    embree::Query query(is_near ? reject_hits_behind_origin : nullptr);
    if (m_instances.instances == 0) {
        embree::clear_blocked(fan, query, m_scene->handle(), origin, 0, length);
    } else {
        std::array<V3f, kPacketSize> origins, directions;
        origins.fill(origin);
        for (int packet = 0; packet < fan.packets; ++packet) {
            uint8_t& lanes = fan.lanes[size_t(packet)];
            if (!lanes)
                continue;
            for (int lane = 0; lane < kPacketSize; ++lane) {
                const int ray = packet * kPacketSize + lane;
                directions[size_t(lane)] = V3f(fan.x[ray], fan.y[ray], fan.z[ray]);
            }
            lanes &= uint8_t(
                ~find_blocked_by_instances(*m_scene, query, origins.data(), directions.data(), lanes, length, is_near));
        }
    }
    Occluder::count(query.cutouts());
}

uint8_t Occluder::find_blocked(const V3f* origins, const V3f* directions, int count, float length, bool is_near,
                               Blocker* blocker) const
{
    const embree::FlushDenormals flush;
    const bool notes = blocker && m_instances.instances == 0;
    embree::Query query(is_near ? notes ? reject_and_note : reject_hits_behind_origin : notes ? note_blocker : nullptr);
    if (m_instances.instances > 0) {
        const uint8_t found = find_blocked_by_instances(*m_scene, query, origins, directions,
                                                        uint8_t((1u << count) - 1), length, is_near);
        Occluder::count(query.cutouts());
        return found;
    }
    RTCRay8 rays;
    alignas(32) int valid[kPacketSize];
    for (int lane = 0; lane < kPacketSize; ++lane) {
        const V3f &origin = origins[lane], &direction = directions[lane];
        rays.org_x[lane] = origin.x, rays.org_y[lane] = origin.y, rays.org_z[lane] = origin.z;
        rays.dir_x[lane] = direction.x, rays.dir_y[lane] = direction.y, rays.dir_z[lane] = direction.z;
        rays.tfar[lane] = length;
        embree::prepare_lane(rays, lane);
        valid[lane] = lane < count ? -1 : 0;
    }
    query.occluded8(valid, m_scene->handle(), rays);
    Occluder::count(query.cutouts());
    if (const auto& [buffers, number] = query.blocker(); buffers) {
        const auto& corners = buffers->triangles[number];
        *blocker = Blocker(buffers->vertices[corners[0]], buffers->vertices[corners[1]], buffers->vertices[corners[2]]);
    }
    uint8_t blocked = 0;
    for (int lane = 0; lane < count; ++lane)
        blocked |= uint8_t(!(rays.tfar[lane] >= 0)) << lane;
    return blocked;
}

void Occluder::find_nearest(const V3f* origins, const V3f* directions, const float* lengths, int count,
                            NearestHit* hits) const
{
    const embree::FlushDenormals flush;
    embree::Query query(reject_hits_behind_origin);
    embree::SceneRays asked;
    asked.placements = &m_scene->placements();
    if (m_instances.instances > 0)
        query.set_scene_rays(&asked);
    RTCRayHit8 rays;
    alignas(32) int valid[kPacketSize];
    for (int lane = 0; lane < kPacketSize; ++lane) {
        const int from = std::min(lane, count - 1); // unused lanes must hold valid numbers too
        const V3f &origin = origins[from], &direction = directions[from];
        asked.origins[lane] = origin;
        asked.directions[lane] = direction;
        rays.ray.org_x[lane] = origin.x, rays.ray.org_y[lane] = origin.y, rays.ray.org_z[lane] = origin.z;
        rays.ray.dir_x[lane] = direction.x, rays.ray.dir_y[lane] = direction.y, rays.ray.dir_z[lane] = direction.z;
        rays.ray.tfar[lane] = lengths[from];
        embree::prepare_lane(rays.ray, lane);
        rays.hit.geomID[lane] = RTC_INVALID_GEOMETRY_ID;
        rays.hit.instID[0][lane] = RTC_INVALID_GEOMETRY_ID;
        valid[lane] = lane < count ? -1 : 0;
    }
    query.intersect8(valid, m_scene->handle(), rays);
    Occluder::count(query.cutouts());
    const auto meshes = uint32_t(m_cutouts.size());
    for (int lane = 0; lane < count; ++lane) {
        NearestHit& hit = hits[lane];
        hit = {};
        const uint32_t geometry = rays.hit.geomID[lane], triangle = rays.hit.primID[lane];
        if (geometry == RTC_INVALID_GEOMETRY_ID)
            continue;
        hit.distance = rays.ray.tfar[lane];
        const uint32_t instance = rays.hit.instID[0][lane];
        const bool is_placed = instance != RTC_INVALID_GEOMETRY_ID;
        if (!is_placed && geometry >= 2 * meshes && geometry < 3 * meshes) { // a strand's ribbon, without triangles
            hit.mesh = geometry % meshes;
            continue;
        }
        hit.normal = V3f(rays.hit.Ng_x[lane], rays.hit.Ng_y[lane], rays.hit.Ng_z[lane]);
        if (is_placed) {
            const auto& placement = m_scene->placements().of(instance);
            hit.mesh = placement.mesh;
            hit.normal = V3f(placement.transform.normal_at(hit.normal));
        } else if (geometry >= 3 * meshes) {
            const embree::Buffers& copy = m_scene->buffers_of(geometry);
            hit.mesh = uint32_t(copy.mesh);
            hit.normal *= copy.is_mirrored ? -1.0f : 1.0f;
        } else {
            hit.mesh = geometry % meshes;
            hit.triangle = triangle;
            if (const Cutouts* cutouts = m_cutouts[hit.mesh].get(); cutouts && geometry < meshes) {
                hit.triangle = cutouts->opaque()[triangle];
            } else if (cutouts) {
                const auto [mixed, weights] = m_scene->buffers_of(geometry).pieces[triangle].whole(
                    triangle, rays.hit.u[lane], rays.hit.v[lane]);
                hit.triangle = cutouts->mixed()[mixed];
                hit.u = weights.x;
                hit.v = weights.y;
                continue;
            }
        }
        hit.u = rays.hit.u[lane];
        hit.v = rays.hit.v[lane];
    }
}

} // namespace vmlight
