// SPDX-License-Identifier: Apache-2.0
#include <vmlight/occluder.h>

#include <vmlight/embree.h>
#include <vmlight/parallel.h>

#include <OpenImageIO/fmath.h>
#include <OpenImageIO/strutil.h>

#include <algorithm>
#include <cmath>
#include <cstring>
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

struct Occluder::Scene
{
    RTCDevice device = nullptr;
    RTCScene scene = nullptr;

    ~Scene()
    {
        if (scene)
            rtcReleaseScene(scene);
        if (device)
            rtcReleaseDevice(device);
    }

    bool attach(const Mesh& mesh, const SceneFrame& frame);
};

bool Occluder::Scene::attach(const Mesh& mesh, const SceneFrame& frame)
{
    if (mesh.triangles.empty())
        return true; // Embree takes no empty buffer
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
    auto scene = std::make_unique<Scene>();
    // A number of threads binds all that the process does by TBB, for good: only where the user gave one.
    const std::string threads = nthreads > 0 ? OIIO::Strutil::fmt::format("threads={},", nthreads) : "";
    scene->device = rtcNewDevice((threads + "set_affinity=0").c_str());
    bool good = scene->device != nullptr;
    if (good) {
        scene->scene = rtcNewScene(scene->device);
        rtcSetSceneFlags(scene->scene, RTC_SCENE_FLAG_ROBUST);
        for (const Mesh* mesh : meshes)
            good = good && scene->attach(*mesh, frame);
        rtcCommitScene(scene->scene);
        good = good && rtcGetDeviceError(scene->device) == RTC_ERROR_NONE;
    }
    if (!good) {
        error = "the ray tracer cannot hold the mesh: out of memory, or no usable processor";
        return false;
    }
    m_scene = std::move(scene);
    return true;
}

void Occluder::clear_blocked(RayFan& fan, const V3f& origin, float length) const
{
    const embree::FlushDenormals flush;
    embree::Query query;
    RTCRay8 rays;
    for (int lane = 0; lane < kPacketSize; ++lane) {
        rays.org_x[lane] = origin.x;
        rays.org_y[lane] = origin.y;
        rays.org_z[lane] = origin.z;
        rays.tnear[lane] = 0;
        rays.time[lane] = 0;
        rays.mask[lane] = ~0u;
        rays.id[lane] = 0;
        rays.flags[lane] = 0;
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

V3f offset_origin(const V3f& p, const V3f& n)
{
    constexpr float kNearOrigin = 1.0f / 32, kAbsolute = 1.0f / 65536, kUlps = 256;
    V3f result;
    for (int axis = 0; axis < 3; ++axis) {
        if (std::abs(p[axis]) < kNearOrigin) {
            result[axis] = p[axis] + kAbsolute * n[axis];
            continue;
        }
        const int32_t ulps = int32_t(kUlps * n[axis]);
        const int32_t bits = OIIO::bitcast<int32_t>(p[axis]) + (p[axis] < 0 ? -ulps : ulps);
        result[axis] = OIIO::bitcast<float>(bits);
    }
    return result;
}

} // namespace vmlight
