// SPDX-License-Identifier: Apache-2.0
/// Camera rays: the nearest triangle or strand of a set of meshes.
#pragma once

#include <vmlight/mesh/mesh.h>
#include <vmlight/trace/occluder.h>

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

namespace vmlight {

/// Where a ray meets a mesh first.
struct SurfaceHit
{
    static constexpr uint32_t kNone = ~0u;
    uint32_t mesh = kNone, triangle = 0;
    /// Of a strand, instead: its span, counted through all strands of the mesh; how far along it, from 0 to 1; and the
    /// distance, in units of the ray's direction.
    uint32_t span = kNone;
    double along = 0, distance = 0;

    bool exists() const { return mesh != kNone; }
    bool is_strand() const { return span != kNone; }
};

/// A ray in object space; what lies before `start`, in units of the direction's length, is passed.
struct SurfaceRay
{
    Imath::V3d origin, direction;
    double start = 0;
};

/// Triangles in an Embree scene, as Occluder has them: built once, then traced from any number of threads.
class VisibleSurface
{
public:
    VisibleSurface();
    ~VisibleSurface();
    VisibleSurface(const VisibleSurface&) = delete;
    VisibleSurface& operator=(const VisibleSurface&) = delete;

    /// Build the scene from the triangles and strands of all `meshes`, whose indices the hits have. False, with the
    /// reason in `error`, if Embree fails (out of memory).
    bool build(const std::vector<const Mesh*>& meshes, const SceneFrame& frame, int nthreads, std::string& error);

    /// The nearest hits of the first `count` of kPacketSize rays, faster if they run side by side. Embree finds the
    /// triangle in floats of the scene's space; the caller who needs the point intersects its plane in double.
    void find(const SurfaceRay* rays, int count, SurfaceHit* hits) const;

private:
    SceneFrame m_frame;
    uint32_t m_meshes = 0;
    std::unique_ptr<embree::Scene> m_scene;
};

} // namespace vmlight
