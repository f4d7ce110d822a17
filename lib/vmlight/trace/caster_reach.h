// SPDX-License-Identifier: Apache-2.0
/// Which occluders can block a ray of the baked mesh at all.
#pragma once

#include <vmlight/mesh/mesh.h>
#include <vmlight/trace/occluder.h>

#include <cstddef>
#include <cstdint>
#include <limits>
#include <string>
#include <vector>

namespace vmlight {

/// What of the given meshes goes into the ray-tracing scene of a bake.
struct SceneChoice
{
    /// Whether the baked mesh occludes itself; whether the occluders occlude.
    bool self = true, occluders = true;
    /// Leave out occluders that no ray can meet: the same visibility without them. False builds them nevertheless.
    bool cull = true;
    /// So many of the first occluders are the rest of the mesh that the baked one is a part of: they go by `self`.
    size_t own_parts = 0;
    /// How triangles are asked that are transparent in part: the same visibility either way.
    CutoutMode cutouts = CutoutMode::micromaps;
    /// How Mesh::instances are traced: the same visibility but for rounding.
    InstanceMode instances = InstanceMode::many;
    /// Length of rays, in mesh units.
    double reach = std::numeric_limits<double>::infinity();

    static SceneChoice within(double reach)
    {
        SceneChoice choice;
        choice.reach = reach;
        return choice;
    }
};

/// An occluder, and whether a ray of the mesh can meet it.
struct CasterReach
{
    enum Verdict
    {
        reaches,
        too_far, ///< farther from the mesh than rays reach
        below_horizon ///< below the tangent plane of every triangle of the mesh
    };
    std::string name;
    int64_t triangles = 0;
    Verdict verdict = reaches;
    /// Between its bounding box and that of the mesh, in mesh units.
    double gap = 0;
    /// Boxes and vertices that a horizon was compared with.
    int64_t tests = 0;
    /// Instead of triangles; and the spans of all of them.
    int64_t strands = 0, spans = 0;

    /// Whether it is in the scene, as occluder number `index`.
    bool is_traced(const SceneChoice& choice, size_t index) const
    {
        return (index < choice.own_parts ? choice.self : choice.occluders) && (verdict == reaches || !choice.cull);
    }
};

/// Judge one occluder, conservatively: what it says to be out of reach, no ray of a texel of `mesh` can meet. Looks at
/// each of its vertices for few triangles only.
CasterReach find_reach(const Mesh& mesh, const Mesh& occluder, const SceneFrame& frame, const SceneChoice& choice);

} // namespace vmlight
