// SPDX-License-Identifier: Apache-2.0
#include <vmlight/trace/occluder.h>

#include <vmlight/trace/embree_scene.h>
#include <vmlight/trace/fan_query.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace vmlight {

using Imath::V3d;
using Imath::V3f;

SceneFrame SceneFrame::around(const Mesh& mesh)
{
    V3d low(std::numeric_limits<double>::infinity()), high(-std::numeric_limits<double>::infinity());
    for (const auto& triangle : mesh.triangles)
        for (uint32_t vertex : triangle)
            for (int axis = 0; axis < 3; ++axis) {
                low[axis] = std::min(low[axis], mesh.positions[vertex][axis]);
                high[axis] = std::max(high[axis], mesh.positions[vertex][axis]);
            }
    return around(low, high);
}

SceneFrame SceneFrame::around(const V3d& low, const V3d& high)
{
    SceneFrame frame;
    const V3d half = (high - low) * 0.5;
    const double reach = std::max({ half.x, half.y, half.z });
    if (!(reach < std::numeric_limits<double>::infinity())) // nothing in it
        return frame;
    frame.centre = low + half;
    if (reach > 0)
        frame.scale = std::ldexp(1.0, -int(std::ceil(std::log2(reach))));
    return frame;
}

namespace {

// Embree's filter of hits: keep those ahead of the ray's origin, computed in double from the same floats.
void reject_hits_behind_origin(const RTCFilterFunctionNArguments* arguments)
{
    const auto& buffers = *static_cast<const embree::Buffers*>(arguments->geometryUserPtr);
    RTCRayN* ray = arguments->ray;
    const unsigned n = arguments->N;
    for (unsigned i = 0; i < n; ++i) {
        if (!arguments->valid[i])
            continue;
        if (!buffers.triangles) // a strand's ribbon faces the ray
            continue;
        const auto& corners = buffers.triangles[RTCHitN_primID(arguments->hit, n, i)];
        const V3d a(buffers.vertices[corners[0]]), b(buffers.vertices[corners[1]]), c(buffers.vertices[corners[2]]);
        const V3d origin(RTCRayN_org_x(ray, n, i), RTCRayN_org_y(ray, n, i), RTCRayN_org_z(ray, n, i));
        const V3d direction(RTCRayN_dir_x(ray, n, i), RTCRayN_dir_y(ray, n, i), RTCRayN_dir_z(ray, n, i));
        const V3d normal = (b - a).cross(c - a);
        if (!((a - origin).dot(normal) / direction.dot(normal) > 0))
            arguments->valid[i] = 0;
    }
}

} // namespace

Occluder::Occluder() = default;
Occluder::~Occluder() = default;

bool Occluder::build(const std::vector<const Mesh*>& meshes, const SceneFrame& frame, int nthreads, std::string& error,
                     CutoutMode mode, const StepListener& at_step)
{
    std::vector<const Mesh*> traced;
    for (size_t i = 0; i < meshes.size(); ++i) {
        if (!meshes[i])
            continue;
        traced.push_back(meshes[i]);
        if (meshes[i]->opacity)
            begin_step(at_step, "sort cut-outs");
        m_cutouts.push_back(Cutouts::make(*meshes[i], uint32_t(i), nthreads, mode));
        if (m_cutouts.back())
            m_counts.add(m_cutouts.back()->counts());
    }
    begin_step(at_step, "build");
    m_scene = embree::Scene::build(traced, frame, nthreads, error, m_cutouts);
    return m_scene != nullptr;
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
    embree::clear_blocked(fan, query, m_scene->handle(), origin, 0, length);
    Occluder::count(query.cutouts());
}

uint8_t Occluder::find_blocked(const V3f* origins, const V3f* directions, int count, float length, bool is_near) const
{
    const embree::FlushDenormals flush;
    embree::Query query(is_near ? reject_hits_behind_origin : nullptr);
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
    RTCRayHit8 rays;
    alignas(32) int valid[kPacketSize];
    for (int lane = 0; lane < kPacketSize; ++lane) {
        const int from = std::min(lane, count - 1); // unused lanes must hold valid numbers too
        const V3f &origin = origins[from], &direction = directions[from];
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
        hit.mesh = geometry % meshes;
        hit.distance = rays.ray.tfar[lane];
        if (geometry >= 2 * meshes)
            continue;
        const Cutouts* cutouts = m_cutouts[hit.mesh].get();
        hit.triangle = !cutouts ? triangle
            : geometry < meshes ? cutouts->opaque()[triangle]
                                : cutouts->mixed()[triangle];
        hit.u = rays.hit.u[lane];
        hit.v = rays.hit.v[lane];
        hit.normal = V3f(rays.hit.Ng_x[lane], rays.hit.Ng_y[lane], rays.hit.Ng_z[lane]);
    }
}

} // namespace vmlight
