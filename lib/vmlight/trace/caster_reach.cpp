// SPDX-License-Identifier: Apache-2.0
#include <vmlight/trace/caster_reach.h>

#include <vmlight/mesh/instances.h>
#include <vmlight/trace/horizon.h>
#include <vmlight/trace/instance_boxes.h>

#include <algorithm>
#include <cmath>

namespace vmlight {

using Imath::V3d;

namespace {

// Vertices to look at, for all triangles of the mesh together: far less work than building the occluder.
constexpr int64_t kVertices = int64_t(1) << 22;

bool hides_all(const Horizon& horizon, const Mesh& occluder, const SceneFrame& frame, int64_t& left)
{
    for (const auto& triangle : occluder.triangles) {
        left -= 3;
        for (const uint32_t vertex : triangle)
            if (left < 0 || !horizon.hides(V3d(frame.to_scene(occluder.positions[vertex]))))
                return false;
    }
    return true;
}

bool hides_all(const Horizon& horizon, const std::vector<SceneBox>& boxes, int64_t& left)
{
    for (const SceneBox& box : boxes)
        if (--left < 0 || !horizon.hides(box))
            return false;
    return true;
}

bool is_below_horizon(const Mesh& mesh, const Mesh& occluder, const std::vector<SceneBox>& instances,
                      const SceneBox& box, const SceneFrame& frame, int64_t& tests)
{
    int64_t left = kVertices;
    bool is_below = true;
    for (const auto& triangle : mesh.triangles) {
        const V3d normal = surface_normal(mesh, triangle);
        if (!(normal.length2() > 0.5)) // no area: no texel
            continue;
        std::array<V3d, 3> corners;
        for (size_t k = 0; k < 3; ++k)
            corners[k] = V3d(frame.to_scene(mesh.positions[triangle[k]]));
        const Horizon horizon(corners, normal);
        ++tests;
        is_below
            = horizon.hides(box) || (hides_all(horizon, occluder, frame, left) && hides_all(horizon, instances, left));
        if (!is_below)
            break;
    }
    tests += kVertices - left;
    return is_below;
}

} // namespace

SceneBox scene_box(const Mesh& mesh, const SceneFrame& frame)
{
    SceneBox box;
    for (const auto& triangle : mesh.triangles)
        for (const uint32_t vertex : triangle)
            box.add(frame.to_scene(mesh.positions[vertex]));
    return box;
}

CasterReach find_reach(const Mesh& mesh, const Mesh& occluder, const SceneFrame& frame, const SceneChoice& choice)
{
    CasterReach found;
    found.name = occluder.name;
    found.triangles = int64_t(occluder.triangles.size()) + (occluder.instances ? occluder.instances->triangles() : 0);
    SceneBox box = scene_box(occluder, frame);
    const std::vector<SceneBox> instances = instance_boxes(occluder, frame);
    for (const SceneBox& instance : instances)
        box.add(instance);
    const double gap = found.triangles == 0 ? 0 : std::sqrt(box.distance2(scene_box(mesh, frame)));
    found.gap = gap / frame.scale;
    // Ray origins are off the surface, and boxes and lengths are floats.
    if (gap > choice.reach * frame.scale * (1 + 1e-5) + 4 * kRayOffset)
        found.verdict = CasterReach::too_far;
    else if (is_below_horizon(mesh, occluder, instances, box, frame, found.tests))
        found.verdict = CasterReach::below_horizon;
    return found;
}

} // namespace vmlight
