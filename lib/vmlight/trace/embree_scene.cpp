// SPDX-License-Identifier: Apache-2.0
#include <vmlight/trace/embree_scene.h>

#include <vmlight/base/available_memory.h>
#include <vmlight/base/format.h>
#include <vmlight/base/process_exit.h>
#include <vmlight/trace/exact_hit.h>

#include <algorithm>

namespace vmlight::embree {

using Imath::V3f;

namespace {

// A triangle takes 65 bytes of a BVH, or 35 of a compact one, through which rays take half as long again. Both meet the
// same triangles, so that it may depend on the machine which it is.
constexpr double kBytesOfTriangle = 65;
bool must_be_compact(size_t triangles)
{
    constexpr double kMost = size_t(1) << 22; // to ask takes reading files of the system
    return double(triangles) > kMost && kBytesOfTriangle * double(triangles) > 0.25 * double(available_memory());
}

// How many triangles use each vertex; 3 if more do.
std::vector<uint8_t> vertex_uses(const Mesh& mesh)
{
    std::vector<uint8_t> uses(mesh.positions.size(), 0);
    for (const auto& triangle : mesh.triangles)
        for (const uint32_t vertex : triangle)
            uses[vertex] = uint8_t(std::min(uses[vertex] + 1, 3));
    return uses;
}

} // namespace

void attach_curves(RTCDevice device, RTCScene scene, const Curves& curves, CurveShape shape, unsigned id,
                   void* user_data, RTCFilterFunctionN occluded)
{
    if (curves.spans().empty())
        return; // Embree refuses empty buffers
    RTCGeometry geometry = rtcNewGeometry(device,
                                          shape == CurveShape::round ? RTC_GEOMETRY_TYPE_ROUND_BSPLINE_CURVE
                                                                     : RTC_GEOMETRY_TYPE_FLAT_BSPLINE_CURVE);
    rtcSetSharedGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT4, curves.controls().data(), 0,
                               sizeof(curves.controls()[0]), curves.controls().size());
    rtcSetSharedGeometryBuffer(geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT, curves.spans().data(), 0,
                               sizeof(curves.spans()[0]), curves.spans().size());
    rtcSetGeometryUserData(geometry, user_data);
    if (occluded)
        rtcSetGeometryOccludedFilterFunction(geometry, occluded);
    rtcCommitGeometry(geometry);
    rtcAttachGeometryByID(scene, geometry, id);
    rtcReleaseGeometry(geometry);
}

Scene::Scene() = default;

Scene::~Scene()
{
    m_whole.release();
    m_distinct.clear();
    if (m_device && !is_process_exiting())
        rtcReleaseDevice(m_device);
}

bool Scene::attach_strands(const Strands& strands, unsigned id, std::string& error)
{
    if (!m_curves.emplace_back().add(strands, m_whole.frame, CurveShape::flat, Curves::kNoOwner, error))
        return false;
    attach_curves(m_device, m_whole.scene, m_curves.back(), CurveShape::flat, id, &m_no_triangles);
    return true;
}

// At the end of a process Embree may be finalised already, and would throw: what it has is left to the system.
void Scene::Part::release()
{
    if (is_process_exiting())
        return;
    if (scene)
        rtcReleaseScene(scene);
    scene = nullptr;
    for (RTCBuffer buffer : vertices)
        rtcReleaseBuffer(buffer);
    vertices.clear();
}

void Scene::start(Part& part, bool is_compact)
{
    part.scene = rtcNewScene(m_device);
    const RTCSceneFlags size = is_compact ? RTC_SCENE_FLAG_COMPACT : RTC_SCENE_FLAG_NONE;
    rtcSetSceneFlags(part.scene, RTCSceneFlags(RTC_SCENE_FLAG_ROBUST | kFilteredByQuery | size));
}

// The triangles of a mesh that lasts are Embree's too, 12 bytes each. Vertices are not: it reads floats.
bool Scene::attach(Part& part, const Mesh& mesh, unsigned id, bool is_lasting)
{
    if (mesh.triangles.empty())
        return true; // Embree refuses empty buffers
    RTCGeometry geometry = rtcNewGeometry(m_device, RTC_GEOMETRY_TYPE_TRIANGLE);
    void* vertices = rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3, sizeof(V3f),
                                             mesh.positions.size());
    const auto* indices = mesh.triangles.data();
    if (is_lasting) {
        rtcSetSharedGeometryBuffer(geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3, indices, 0, sizeof(*indices),
                                   mesh.triangles.size());
    } else {
        auto* copies = static_cast<std::array<uint32_t, 3>*>(rtcSetNewGeometryBuffer(
            geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3, sizeof(*indices), mesh.triangles.size()));
        if (copies)
            std::copy(mesh.triangles.begin(), mesh.triangles.end(), copies);
        indices = copies;
    }
    const bool good = vertices && indices;
    if (good) {
        for (size_t v = 0; v < mesh.positions.size(); ++v)
            static_cast<V3f*>(vertices)[v] = part.frame.to_scene(mesh.positions[v]);
        part.buffers.push_back({ static_cast<V3f*>(vertices), indices, mesh.triangles.size() });
        rtcSetGeometryUserData(geometry, &part.buffers.back());
        rtcCommitGeometry(geometry);
        rtcAttachGeometryByID(part.scene, geometry, id);
    }
    rtcReleaseGeometry(geometry);
    return good;
}

bool Scene::attach_opaque(Part& part, RTCBuffer vertices, const Mesh& mesh, const Cutouts& cutouts, unsigned id)
{
    const std::vector<uint32_t>& triangles = cutouts.opaque();
    if (triangles.empty())
        return true;
    RTCGeometry geometry = rtcNewGeometry(m_device, RTC_GEOMETRY_TYPE_TRIANGLE);
    rtcSetGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3, vertices, 0, sizeof(V3f),
                         mesh.positions.size());
    auto* indices = static_cast<std::array<uint32_t, 3>*>(rtcSetNewGeometryBuffer(
        geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3, 3 * sizeof(uint32_t), triangles.size()));
    if (indices) {
        for (size_t i = 0; i < triangles.size(); ++i)
            indices[i] = mesh.triangles[triangles[i]];
        part.buffers.push_back({ static_cast<const V3f*>(rtcGetBufferData(vertices)), indices, triangles.size() });
        rtcSetGeometryUserData(geometry, &part.buffers.back());
        rtcCommitGeometry(geometry);
        rtcAttachGeometryByID(part.scene, geometry, id);
    }
    rtcReleaseGeometry(geometry);
    return indices != nullptr;
}

// Each has vertices of its own: those of neighbours are trimmed in other ways.
bool Scene::attach_mixed(Part& part, const V3f* vertices, const Mesh& mesh, const Cutouts& cutouts, unsigned id)
{
    const std::vector<uint32_t>& triangles = cutouts.mixed();
    if (triangles.empty())
        return true;
    RTCGeometry geometry = rtcNewGeometry(m_device, RTC_GEOMETRY_TYPE_TRIANGLE);
    auto* corners = static_cast<std::array<V3f, 3>*>(rtcSetNewGeometryBuffer(
        geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3, sizeof(V3f), 3 * triangles.size()));
    auto* indices = static_cast<std::array<uint32_t, 3>*>(rtcSetNewGeometryBuffer(
        geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3, 3 * sizeof(uint32_t), triangles.size()));
    const bool good = corners && indices;
    if (good) {
        part.buffers.push_back({ vertices, nullptr, triangles.size(), &cutouts });
        Buffers& buffers = part.buffers.back();
        buffers.whole_triangles.reserve(triangles.size());
        for (size_t i = 0; i < triangles.size(); ++i) {
            const auto& whole = buffers.whole_triangles.emplace_back(mesh.triangles[triangles[i]]);
            for (size_t k = 0; k < 3; ++k) {
                corners[i][k] = vertices[whole[k]];
                indices[i][k] = uint32_t(3 * i + k);
            }
        }
        // Within an instance Embree's own hits are off by more than edges move outwards.
        if (&part == &m_whole)
            buffers.pieces = trim_triangles(corners, buffers.whole_triangles, vertex_uses(mesh),
                                            [&](size_t i) { return cutouts.stopping(uint32_t(i)); });
        else
            buffers.pieces = whole_pieces(corners, triangles.size());
        buffers.triangles = buffers.whole_triangles.data();
        rtcSetGeometryUserData(geometry, &buffers);
        rtcSetGeometryOccludedFilterFunction(geometry, reject_open_hits);
        rtcSetGeometryIntersectFilterFunction(geometry, reject_open_hits);
        rtcCommitGeometry(geometry);
        rtcAttachGeometryByID(part.scene, geometry, id);
    }
    rtcReleaseGeometry(geometry);
    return good;
}

// Transparent triangles are in neither geometry.
bool Scene::attach_sorted(Part& part, const Mesh& mesh, const Cutouts& cutouts, unsigned id, unsigned mixed_id)
{
    // Embree reads four floats of each vertex.
    RTCBuffer vertices = rtcNewBuffer(m_device, mesh.positions.size() * sizeof(V3f) + 16);
    auto* positions = vertices ? static_cast<V3f*>(rtcGetBufferData(vertices)) : nullptr;
    if (!positions)
        return false;
    part.vertices.push_back(vertices);
    for (size_t v = 0; v < mesh.positions.size(); ++v)
        positions[v] = part.frame.to_scene(mesh.positions[v]);
    return attach_opaque(part, vertices, mesh, cutouts, id) && attach_mixed(part, positions, mesh, cutouts, mixed_id);
}

std::unique_ptr<Scene> Scene::build(const std::vector<const Mesh*>& meshes, const SceneFrame& frame, int nthreads,
                                    std::string& error, const std::vector<std::unique_ptr<const Cutouts>>& cutouts,
                                    const std::vector<PlacedMeshes>& placed, const Mesh* lasting)
{
    auto scene = std::make_unique<Scene>();
    scene->m_placements = std::make_unique<Placements>();
    error = "Embree cannot build the ray-tracing scene: out of memory, or the CPU is not supported";
    // A thread count limits all of the process's TBB work for good: set it only if the user did.
    const std::string threads = nthreads > 0 ? format("threads={},", nthreads) : "";
    scene->m_device = rtcNewDevice((threads + "set_affinity=0").c_str());
    if (!scene->m_device)
        return nullptr;
    size_t triangles = 0;
    for (const Mesh* mesh : meshes)
        triangles += mesh->triangles.size();
    Part& whole = scene->m_whole;
    whole.frame = frame;
    scene->start(whole, must_be_compact(triangles));
    bool good = true;
    for (size_t id = 0; id < meshes.size() && good; ++id) {
        const size_t first = whole.buffers.size();
        good = id < cutouts.size() && cutouts[id]
            ? scene->attach_sorted(whole, *meshes[id], *cutouts[id], unsigned(id), unsigned(meshes.size() + id))
            : scene->attach(whole, *meshes[id], unsigned(id), meshes[id] == lasting);
        if (good && meshes[id]->strands)
            good = scene->attach_strands(*meshes[id]->strands, unsigned(2 * meshes.size() + id), error);
        for (size_t i = first; i < whole.buffers.size(); ++i)
            whole.buffers[i].mesh = id;
    }
    good = good && scene->attach_placed(placed, unsigned(3 * meshes.size()), error);
    if (good)
        rtcCommitScene(whole.scene);
    if (!good || rtcGetDeviceError(scene->m_device) != RTC_ERROR_NONE)
        return nullptr;
    error.clear();
    return scene;
}

} // namespace vmlight::embree
