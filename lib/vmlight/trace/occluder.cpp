// SPDX-License-Identifier: Apache-2.0
#include <vmlight/trace/occluder.h>

#include <vmlight/base/format.h>
#include <vmlight/base/parallel.h>
#include <vmlight/trace/embree.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <deque>
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
    SceneFrame frame;
    const V3d half = (high - low) * 0.5;
    const double reach = std::max({ half.x, half.y, half.z });
    if (!(reach < std::numeric_limits<double>::infinity())) // no triangle
        return frame;
    frame.centre = low + half;
    if (reach > 0)
        frame.scale = std::ldexp(1.0, -int(std::ceil(std::log2(reach))));
    return frame;
}

namespace {

// Embree's buffers of a mesh.
struct Buffers
{
    const V3f* vertices;
    const std::array<uint32_t, 3>* triangles;
};

// Embree's filter of hits: keep those ahead of the ray's origin, computed in double from the same floats.
void reject_hits_behind_origin(const RTCFilterFunctionNArguments* arguments)
{
    const Buffers& buffers = *static_cast<const Buffers*>(arguments->geometryUserPtr);
    RTCRayN* ray = arguments->ray;
    const unsigned n = arguments->N;
    for (unsigned i = 0; i < n; ++i) {
        if (!arguments->valid[i])
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

// Set all of a ray but its origin, direction and length.
void prepare_lane(RTCRay8& rays, int lane)
{
    rays.tnear[lane] = 0;
    rays.time[lane] = 0;
    rays.mask[lane] = ~0u;
    rays.id[lane] = 0;
    rays.flags[lane] = 0;
}

} // namespace

struct Occluder::EmbreeScene
{
    RTCDevice device = nullptr;
    RTCScene scene = nullptr;
    std::deque<Buffers> buffers; // Embree keeps pointers to its elements

    ~EmbreeScene()
    {
        if (scene)
            rtcReleaseScene(scene);
        if (device)
            rtcReleaseDevice(device);
    }

    bool attach(const Mesh& mesh, const SceneFrame& frame);
};

bool Occluder::EmbreeScene::attach(const Mesh& mesh, const SceneFrame& frame)
{
    if (mesh.triangles.empty())
        return true; // Embree refuses empty buffers
    RTCGeometry geometry = rtcNewGeometry(device, RTC_GEOMETRY_TYPE_TRIANGLE);
    void* vertices = rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3, sizeof(V3f),
                                             mesh.positions.size());
    void* indices = rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3, 3 * sizeof(uint32_t),
                                            mesh.triangles.size());
    const bool good = vertices && indices;
    if (good) {
        for (size_t v = 0; v < mesh.positions.size(); ++v)
            static_cast<V3f*>(vertices)[v] = frame.to_scene(mesh.positions[v]);
        std::memcpy(indices, mesh.triangles.data(), mesh.triangles.size() * 3 * sizeof(uint32_t));
        buffers.push_back({ static_cast<V3f*>(vertices), static_cast<std::array<uint32_t, 3>*>(indices) });
        rtcSetGeometryUserData(geometry, &buffers.back());
        rtcCommitGeometry(geometry);
        rtcAttachGeometry(scene, geometry);
    }
    rtcReleaseGeometry(geometry);
    return good;
}

Occluder::Occluder() = default;
Occluder::~Occluder() = default;

bool Occluder::build(const std::vector<const Mesh*>& meshes, const SceneFrame& frame, int nthreads, std::string& error)
{
    auto scene = std::make_unique<EmbreeScene>();
    // A thread count limits all of the process's TBB work for good: set it only if the user did.
    const std::string threads = nthreads > 0 ? format("threads={},", nthreads) : "";
    scene->device = rtcNewDevice((threads + "set_affinity=0").c_str());
    bool good = scene->device != nullptr;
    if (good) {
        scene->scene = rtcNewScene(scene->device);
        rtcSetSceneFlags(scene->scene, RTCSceneFlags(RTC_SCENE_FLAG_ROBUST | embree::kFilteredByQuery));
        for (const Mesh* mesh : meshes)
            good = good && scene->attach(*mesh, frame);
        rtcCommitScene(scene->scene);
        good = good && rtcGetDeviceError(scene->device) == RTC_ERROR_NONE;
    }
    if (!good) {
        error = "Embree cannot build the ray-tracing scene: out of memory, or the CPU is not supported";
        return false;
    }
    m_scene = std::move(scene);
    return true;
}

void Occluder::clear_blocked(RayFan& fan, const V3f& origin, float length, bool is_near) const
{
    const embree::FlushDenormals flush;
    embree::Query query(is_near ? reject_hits_behind_origin : nullptr);
    RTCRay8 rays;
    for (int lane = 0; lane < kPacketSize; ++lane) {
        rays.org_x[lane] = origin.x;
        rays.org_y[lane] = origin.y;
        rays.org_z[lane] = origin.z;
        prepare_lane(rays, lane);
    }
    for (int packet = 0; packet < fan.packets; ++packet) {
        const uint8_t live = fan.lanes[packet];
        if (!live)
            continue;
        alignas(32) int valid[kPacketSize];
        for (int lane = 0; lane < kPacketSize; ++lane) {
            valid[lane] = live >> lane & 1 ? -1 : 0;
            rays.tfar[lane] = length;
        }
        const int first = packet * kPacketSize;
        std::memcpy(rays.dir_x, fan.x + first, sizeof(rays.dir_x));
        std::memcpy(rays.dir_y, fan.y + first, sizeof(rays.dir_y));
        std::memcpy(rays.dir_z, fan.z + first, sizeof(rays.dir_z));
        query.occluded8(valid, m_scene->scene, rays);
        uint8_t open = 0;
        for (int lane = 0; lane < kPacketSize; ++lane)
            open |= uint8_t(rays.tfar[lane] >= 0) << lane; // Embree sets tfar to -infinity where a ray is blocked
        fan.lanes[packet] = live & open;
    }
}

uint8_t Occluder::find_blocked(const V3f* origins, const V3f* directions, int count, float length) const
{
    const embree::FlushDenormals flush;
    embree::Query query(reject_hits_behind_origin);
    RTCRay8 rays;
    alignas(32) int valid[kPacketSize];
    for (int lane = 0; lane < kPacketSize; ++lane) {
        const V3f &origin = origins[lane], &direction = directions[lane];
        rays.org_x[lane] = origin.x, rays.org_y[lane] = origin.y, rays.org_z[lane] = origin.z;
        rays.dir_x[lane] = direction.x, rays.dir_y[lane] = direction.y, rays.dir_z[lane] = direction.z;
        rays.tfar[lane] = length;
        prepare_lane(rays, lane);
        valid[lane] = lane < count ? -1 : 0;
    }
    query.occluded8(valid, m_scene->scene, rays);
    uint8_t blocked = 0;
    for (int lane = 0; lane < count; ++lane)
        blocked |= uint8_t(!(rays.tfar[lane] >= 0)) << lane;
    return blocked;
}

} // namespace vmlight
