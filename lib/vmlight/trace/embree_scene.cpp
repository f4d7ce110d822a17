// SPDX-License-Identifier: Apache-2.0
#include <vmlight/trace/embree_scene.h>

#include <vmlight/base/format.h>

#include <cstring>

namespace vmlight::embree {

using Imath::V3f;

Scene::~Scene()
{
    if (m_scene)
        rtcReleaseScene(m_scene);
    if (m_device)
        rtcReleaseDevice(m_device);
}

bool Scene::attach(const Mesh& mesh, const SceneFrame& frame, unsigned id)
{
    if (mesh.triangles.empty())
        return true; // Embree refuses empty buffers
    RTCGeometry geometry = rtcNewGeometry(m_device, RTC_GEOMETRY_TYPE_TRIANGLE);
    void* vertices = rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3, sizeof(V3f),
                                             mesh.positions.size());
    void* indices = rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3, 3 * sizeof(uint32_t),
                                            mesh.triangles.size());
    const bool good = vertices && indices;
    if (good) {
        for (size_t v = 0; v < mesh.positions.size(); ++v)
            static_cast<V3f*>(vertices)[v] = frame.to_scene(mesh.positions[v]);
        std::memcpy(indices, mesh.triangles.data(), mesh.triangles.size() * 3 * sizeof(uint32_t));
        m_buffers.push_back({ static_cast<V3f*>(vertices), static_cast<std::array<uint32_t, 3>*>(indices) });
        rtcSetGeometryUserData(geometry, &m_buffers.back());
        rtcCommitGeometry(geometry);
        rtcAttachGeometryByID(m_scene, geometry, id);
    }
    rtcReleaseGeometry(geometry);
    return good;
}

std::unique_ptr<Scene> Scene::build(const std::vector<const Mesh*>& meshes, const SceneFrame& frame, int nthreads,
                                    std::string& error)
{
    auto scene = std::make_unique<Scene>();
    // A thread count limits all of the process's TBB work for good: set it only if the user did.
    const std::string threads = nthreads > 0 ? format("threads={},", nthreads) : "";
    scene->m_device = rtcNewDevice((threads + "set_affinity=0").c_str());
    bool good = scene->m_device != nullptr;
    if (good) {
        scene->m_scene = rtcNewScene(scene->m_device);
        rtcSetSceneFlags(scene->m_scene, RTCSceneFlags(RTC_SCENE_FLAG_ROBUST | kFilteredByQuery));
        for (size_t id = 0; id < meshes.size(); ++id)
            good = good && scene->attach(*meshes[id], frame, unsigned(id));
        rtcCommitScene(scene->m_scene);
        good = good && rtcGetDeviceError(scene->m_device) == RTC_ERROR_NONE;
    }
    if (good)
        return scene;
    error = "Embree cannot build the ray-tracing scene: out of memory, or the CPU is not supported";
    return nullptr;
}

} // namespace vmlight::embree
