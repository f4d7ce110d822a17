// SPDX-License-Identifier: Apache-2.0
#include <vmlight/trace/visible_surface.h>

#include <vmlight/trace/embree_scene.h>

#include <limits>

namespace vmlight {

using Imath::V3d;
using Imath::V3f;

VisibleSurface::VisibleSurface() = default;
VisibleSurface::~VisibleSurface() = default;

bool VisibleSurface::build(const std::vector<const Mesh*>& meshes, const SceneFrame& frame, int nthreads,
                           std::string& error)
{
    m_frame = frame;
    m_meshes = uint32_t(meshes.size());
    m_scene = embree::Scene::build(meshes, frame, nthreads, error);
    return m_scene != nullptr;
}

void VisibleSurface::find(const SurfaceRay* rays, int count, SurfaceHit* hits) const
{
    const embree::FlushDenormals flush;
    RTCRayHit8 packet;
    alignas(32) int valid[kPacketSize];
    for (int lane = 0; lane < kPacketSize; ++lane) {
        const SurfaceRay& ray = rays[lane < count ? lane : 0];
        // The scene is [-1, 1]: floats are exact enough from where the ray comes near it.
        const V3d& direction = ray.direction;
        const V3d origin = (ray.origin + direction * ray.start - m_frame.centre) * m_frame.scale;
        packet.ray.org_x[lane] = float(origin.x), packet.ray.org_y[lane] = float(origin.y),
        packet.ray.org_z[lane] = float(origin.z);
        packet.ray.dir_x[lane] = float(direction.x), packet.ray.dir_y[lane] = float(direction.y),
        packet.ray.dir_z[lane] = float(direction.z);
        packet.ray.tfar[lane] = std::numeric_limits<float>::infinity();
        embree::prepare_lane(packet.ray, lane);
        packet.hit.geomID[lane] = RTC_INVALID_GEOMETRY_ID;
        packet.hit.instID[0][lane] = RTC_INVALID_GEOMETRY_ID;
        valid[lane] = lane < count ? -1 : 0;
    }
    embree::intersect8(valid, m_scene->handle(), packet);
    for (int lane = 0; lane < count; ++lane) {
        SurfaceHit& hit = hits[lane];
        hit = {};
        const uint32_t geometry = packet.hit.geomID[lane];
        if (geometry == RTC_INVALID_GEOMETRY_ID)
            continue;
        const bool is_strand = geometry >= m_meshes;
        hit.mesh = geometry % m_meshes;
        (is_strand ? hit.span : hit.triangle) = packet.hit.primID[lane];
        hit.along = double(packet.hit.u[lane]);
        hit.distance = rays[lane].start + double(packet.ray.tfar[lane]) / m_frame.scale;
    }
}

} // namespace vmlight
