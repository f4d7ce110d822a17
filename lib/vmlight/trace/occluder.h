// SPDX-License-Identifier: Apache-2.0
/// "Is this ray blocked?": the triangles that cast, behind one question.
#pragma once

#include <Imath/ImathVec.h>
#include <vmlight/math/ray_fan.h>
#include <vmlight/mesh/mesh.h>

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

namespace vmlight {

/// Where positions become float: object space moved and scaled so that the baked mesh fills [-1, 1]. The scale is a
/// power of two, so that scaling itself rounds nothing, and results do not depend on the mesh's units.
struct SceneFrame
{
    Imath::V3d centre { 0 };
    double scale = 1;

    static SceneFrame around(const Mesh& mesh);
    Imath::V3f to_scene(const Imath::V3d& p) const { return Imath::V3f((p - centre) * scale); }
};

/// Triangles in an Embree scene, built once, then asked from any number of threads.
class Occluder
{
public:
    Occluder();
    ~Occluder();
    Occluder(const Occluder&) = delete;
    Occluder& operator=(const Occluder&) = delete;

    /// Take the triangles of all `meshes` and build the scene. False, with the reason in `error`, if Embree fails
    /// (memory). Robust traversal: no leaks between triangles that share vertices.
    bool build(const std::vector<const Mesh*>& meshes, const SceneFrame& frame, int nthreads, std::string& error);

    /// Clear the bit of each ray that a triangle blocks within `length` (in scene units) of `origin`. Rays start
    /// at `origin` itself, which must be off the surface: see SurfacePoint. Not checked: that build() succeeded.
    /// @param is_near  of `origin`: which side of a triangle it is on is worked out in double, since Embree's floats
    ///                 may err. What they miss is missed
    void clear_blocked(RayFan& fan, const Imath::V3f& origin, float length, bool is_near = false) const;

    /// Which of the first `count` of kPacketSize rays a triangle blocks within `length`: bit k for ray k. As with
    /// `is_near`.
    uint8_t find_blocked(const Imath::V3f* origins, const Imath::V3f* directions, int count, float length) const;

private:
    struct Scene;
    std::unique_ptr<Scene> m_scene;
};

} // namespace vmlight
