// SPDX-License-Identifier: Apache-2.0
/// "Is this ray blocked?": the triangles that cast, behind one question.
#pragma once

#include <vmlight/export.h>

#include <Imath/ImathVec.h>
#include <vmlight/mesh.h>
#include <vmlight/ray_fan.h>

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

    VMLIGHT_API static SceneFrame around(const Mesh& mesh);
    Imath::V3f to_scene(const Imath::V3d& p) const { return Imath::V3f((p - centre) * scale); }
};

/// Triangles in an Embree scene, built once, then asked from any number of threads.
class Occluder
{
public:
    VMLIGHT_API Occluder();
    VMLIGHT_API ~Occluder();
    Occluder(const Occluder&) = delete;
    Occluder& operator=(const Occluder&) = delete;

    /// Take the triangles of all `meshes` and build the scene. False, with the reason in `error`, if Embree fails
    /// (memory). Robust traversal: no leaks between triangles that share vertices.
    VMLIGHT_API bool build(const std::vector<const Mesh*>& meshes, const SceneFrame& frame, int nthreads,
                           std::string& error);

    /// Clear the bit of each ray that a triangle blocks within `length` (in scene units) of `origin`. Rays start
    /// at `origin` itself: see offset_origin(). Not checked: that build() succeeded.
    VMLIGHT_API void clear_blocked(RayFan& fan, const Imath::V3f& origin, float length) const;

private:
    struct Scene;
    std::unique_ptr<Scene> m_scene;
};

/// A point of a surface, pushed off it along its geometric normal just far enough that rays from it cannot meet the
/// surface by rounding: 256 ulps a component, and 2^-16 of the scene's unit for components below 1/32. Right only in a
/// SceneFrame: elsewhere it leaks or hits falsely (measured over scales of 1e-6 to 1e6 and offsets of up to 1e7).
/// Source: C. Waechter, N. Binder, "A Fast and Robust Method for Avoiding Self-Intersection", Ray Tracing Gems, ch. 6.
VMLIGHT_API Imath::V3f offset_origin(const Imath::V3f& p, const Imath::V3f& geometric_normal);

/// How far offset_origin() may move a point of the baked mesh: 256 ulps of 1, with room to spare.
constexpr float kOffsetLength = 1.0f / 16384;

} // namespace vmlight
