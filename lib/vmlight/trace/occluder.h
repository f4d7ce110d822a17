// SPDX-License-Identifier: Apache-2.0
/// Shadow rays: which rays are blocked by a set of meshes.
#pragma once

#include <Imath/ImathVec.h>
#include <vmlight/base/progress.h>
#include <vmlight/math/ray_fan.h>
#include <vmlight/mesh/mesh.h>
#include <vmlight/trace/cutouts.h>
#include <vmlight/trace/instance_plan.h>
#include <vmlight/trace/scene_frame.h>

#include <array>
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

namespace vmlight {

class Blocker;

namespace embree {
class Scene;
}

/// The triangles of one mesh in a ray-tracing scene, as they are traced.
struct TracedTriangles
{
    const Imath::V3f* vertices;
    const std::array<uint32_t, 3>* triangles;
    size_t count;
    size_t mesh = 0; ///< its place among those that are traced: see BakeScene::casters()

    const Imath::V3f& corner(size_t triangle, int k) const { return vertices[triangles[triangle][size_t(k)]]; }
};

/// What a ray meets first.
struct NearestHit
{
    static constexpr uint32_t kNone = ~0u;
    uint32_t mesh = kNone; ///< its number among those that Occluder::build() was given
    uint32_t triangle = 0; ///< of that mesh; of Mesh::instances, not to be used
    float u = 0, v = 0; ///< weights of the triangle's second and third corners
    float distance = 0; ///< in lengths of the ray's direction
    Imath::V3f normal { 0 }; ///< of the triangle, by its winding; of any length; 0 of a strand, which has no triangle

    bool exists() const { return mesh != kNone; }
};

/// Triangles and curves in an Embree scene: built once, then traced from any number of threads.
class Occluder
{
public:
    Occluder();
    ~Occluder();
    Occluder(const Occluder&) = delete;
    Occluder& operator=(const Occluder&) = delete;

    /// Build the scene from the triangles of all `meshes`; nullptr is one that is left out, and keeps its number, on
    /// which chance depends where opacity is in between. False, with the reason in `error`, if Embree fails (out of
    /// memory). Traversal is robust: rays do not leak between triangles that share vertices.
    ///
    /// Mesh::strands are ribbons that face each ray: their shade is that of tubes from 3 radii on.
    ///
    /// What Mesh::opacity says of a mesh is honoured: rays pass where it is transparent, and as often as it says where
    /// it is in between.
    ///
    /// Mesh::instances are met as if they were triangles of their mesh, but for the rounding of their transforms: of
    /// some 1e-6 of the frame's size.
    ///
    /// @param lasting  the one of `meshes` that outlives this and does not change meanwhile, so that its triangles need
    ///                 not be copied; nullptr: none does
    bool build(const std::vector<const Mesh*>& meshes, const SceneFrame& frame, int nthreads, std::string& error,
               CutoutMode mode = CutoutMode::micromaps, const StepListener& at_step = {},
               InstanceMode instances = InstanceMode::many, const Mesh* lasting = nullptr);

    /// Clear the bit of each ray that a triangle blocks within `length` (in scene units) of `origin`, which must be off
    /// the surface: see SurfacePoint. Not checked: that build() succeeded.
    /// @param is_near  `origin` is so near to the surface that Embree's floats may put it on the wrong side of a
    ///                 triangle: recheck the side of each hit in double. Hits that Embree misses stay missed
    void clear_blocked(RayFan& fan, const Imath::V3f& origin, float length, bool is_near = false) const;

    /// Which of the first `count` of kPacketSize rays are blocked within `length`: bit k for ray k. For rays that run
    /// side by side.
    /// @param origins, directions  kPacketSize of each: those of unused rays are read, and must be valid numbers
    /// @param is_near  as for clear_blocked(): one of the origins is
    /// @param blocker  if not nullptr, set to an opaque triangle that blocks one of them. Not set if none does, or in a
    ///                 scene with instances
    uint8_t find_blocked(const Imath::V3f* origins, const Imath::V3f* directions, int count, float length,
                         bool is_near = true, Blocker* blocker = nullptr) const;

    /// What the first `count` of kPacketSize rays meet first within their lengths (in scene units), from origins that
    /// are off the surface. The same triangles block rays as for find_blocked().
    void find_nearest(const Imath::V3f* origins, const Imath::V3f* directions, const float* lengths, int count,
                      NearestHit* hits) const;

    /// After build().
    const CutoutCounts& cutouts() const { return m_counts; }
    /// Whether light passes the same points of the same triangles of two meshes, by their places among those traced.
    bool has_cutouts_of(size_t mesh, const Occluder& other, size_t its_mesh) const;
    /// What rays have asked so far.
    CutoutWork cutout_work() const { return { m_hits, m_lookups }; }
    /// Whether rays can meet strands, too.
    bool has_strands() const;
    /// All triangles that rays can meet, but for those of instances. Valid as long as this is.
    std::vector<TracedTriangles> triangles() const;
    /// Of Mesh::instances.
    const InstanceCounts& instances() const { return m_instances; }
    bool has_instances() const { return m_instances.instances + m_instances.copies > 0; }

private:
    void count(const CutoutWork& work) const;

    std::vector<std::unique_ptr<const Cutouts>> m_cutouts, m_distinct_cutouts;
    InstanceCounts m_instances;
    CutoutCounts m_counts;
    mutable std::atomic<int64_t> m_hits { 0 }, m_lookups { 0 };
    std::unique_ptr<embree::Scene> m_scene; // refers to m_cutouts
};

} // namespace vmlight
