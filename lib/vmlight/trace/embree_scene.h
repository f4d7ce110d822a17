// SPDX-License-Identifier: Apache-2.0
/// An Embree scene of triangles, which Occluder and VisibleSurface trace.
#pragma once

#include <vmlight/mesh/mesh.h>
#include <vmlight/trace/embree.h>
#include <vmlight/trace/occluder.h>

#include <array>
#include <cstdint>
#include <deque>
#include <memory>
#include <string>
#include <vector>

namespace vmlight::embree {

/// Embree's buffers of a mesh: the user data of its geometry.
struct Buffers
{
    const Imath::V3f* vertices;
    const std::array<uint32_t, 3>* triangles;
};

class Scene
{
public:
    Scene() = default;
    ~Scene();
    Scene(const Scene&) = delete;
    Scene& operator=(const Scene&) = delete;

    /// Build the scene from the triangles of all `meshes`; the geometry of each has its index as its ID. Traversal is
    /// robust. nullptr, with the reason in `error`, if Embree fails (out of memory).
    static std::unique_ptr<Scene> build(const std::vector<const Mesh*>& meshes, const SceneFrame& frame, int nthreads,
                                        std::string& error);

    RTCScene handle() const { return m_scene; }

private:
    bool attach(const Mesh& mesh, const SceneFrame& frame, unsigned id);

    RTCDevice m_device = nullptr;
    RTCScene m_scene = nullptr;
    std::deque<Buffers> m_buffers; // Embree keeps pointers to its elements
};

/// Set all of a lane of RTCRay8 but its origin, direction and length.
inline void prepare_lane(RTCRay8& rays, int lane)
{
    rays.tnear[lane] = 0;
    rays.time[lane] = 0;
    rays.mask[lane] = ~0u;
    rays.id[lane] = 0;
    rays.flags[lane] = 0;
}

} // namespace vmlight::embree
