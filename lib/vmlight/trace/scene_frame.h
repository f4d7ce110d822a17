// SPDX-License-Identifier: Apache-2.0
/// Where the ray-tracing scene is, and how large: the space in which rays are traced.
#pragma once

#include <vmlight/mesh/mesh.h>

#include <Imath/ImathVec.h>

namespace vmlight {

/// From object space to the space of the ray-tracing scene, where positions are float: recentred and scaled so that the
/// baked mesh fits [-1, 1]. The scale is a power of two, so that scaling is exact and results do not depend on units.
struct SceneFrame
{
    Imath::V3d centre { 0 };
    double scale = 1;

    static SceneFrame around(const Mesh& mesh);
    /// The box need not be one: without a point in it the frame is that of object space.
    static SceneFrame around(const Imath::V3d& low, const Imath::V3d& high);
    Imath::V3f to_scene(const Imath::V3d& p) const { return Imath::V3f((p - centre) * scale); }
};

} // namespace vmlight
