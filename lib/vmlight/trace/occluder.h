// SPDX-License-Identifier: Apache-2.0
/// Shadow rays: which rays are blocked by a set of meshes.
#pragma once

#include <Imath/ImathVec.h>
#include <vmlight/math/ray_fan.h>
#include <vmlight/mesh/mesh.h>

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

namespace vmlight {

namespace embree {
class Scene;
}

/// From object space to the space of the ray-tracing scene, where positions are float: recentred and scaled so that the
/// baked mesh fits [-1, 1]. The scale is a power of two, so that scaling is exact and results do not depend on units.
struct SceneFrame
{
    Imath::V3d centre { 0 };
    double scale = 1;

    static SceneFrame around(const Mesh& mesh);
    Imath::V3f to_scene(const Imath::V3d& p) const { return Imath::V3f((p - centre) * scale); }
};

/// Triangles in an Embree scene: built once, then traced from any number of threads.
class Occluder
{
public:
    Occluder();
    ~Occluder();
    Occluder(const Occluder&) = delete;
    Occluder& operator=(const Occluder&) = delete;

    /// Build the scene from the triangles of all `meshes`. False, with the reason in `error`, if Embree fails (out of
    /// memory). Traversal is robust: rays do not leak between triangles that share vertices.
    bool build(const std::vector<const Mesh*>& meshes, const SceneFrame& frame, int nthreads, std::string& error);

    /// Clear the bit of each ray that a triangle blocks within `length` (in scene units) of `origin`, which must be off
    /// the surface: see SurfacePoint. Not checked: that build() succeeded.
    /// @param is_near  `origin` is so near to the surface that Embree's floats may put it on the wrong side of a
    ///                 triangle: recheck the side of each hit in double. Hits that Embree misses stay missed
    void clear_blocked(RayFan& fan, const Imath::V3f& origin, float length, bool is_near = false) const;

    /// Which of the first `count` of kPacketSize rays are blocked within `length`: bit k for ray k. Rechecks hits as
    /// for `is_near`.
    uint8_t find_blocked(const Imath::V3f* origins, const Imath::V3f* directions, int count, float length) const;

private:
    std::unique_ptr<embree::Scene> m_scene;
};

} // namespace vmlight
