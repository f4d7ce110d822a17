// SPDX-License-Identifier: Apache-2.0
#include <vmlight/trace/caster_reach.h>

#include <vmlight/mesh/instances.h>
#include <vmlight/mesh/strands.h>
#include <vmlight/trace/horizon.h>
#include <vmlight/trace/instance_boxes.h>

#include <algorithm>
#include <cmath>

namespace vmlight {

using Imath::V3d;

namespace {

// Vertices to look at, for all triangles of the mesh together: far less work than building the occluder.
constexpr int64_t kVertices = int64_t(1) << 22;

// The box around a point of a strand, which is at most that thick. The curve is within the hull of such boxes.
SceneBox point_box(const V3d& point, double thickest, const SceneFrame& frame)
{
    SceneBox box;
    box.add(frame.to_scene(point - V3d(thickest)));
    box.add(frame.to_scene(point + V3d(thickest)));
    return box;
}

template <class Look> bool for_points(const Strands& strands, const SceneFrame& frame, const Look& look)
{
    for (size_t strand = 0; strand < strands.count(); ++strand) {
        const double thickest = thickest_radius(strands, strand);
        for (size_t p = strands.begin(strand); p < strands.end(strand); ++p)
            if (!look(point_box(strands.points[p], thickest, frame)))
                return false;
    }
    return true;
}

bool hides_all(const Horizon& horizon, const Mesh& occluder, const SceneFrame& frame, int64_t& left)
{
    for (const auto& triangle : occluder.triangles) {
        left -= 3;
        for (const uint32_t vertex : triangle)
            if (left < 0 || !horizon.hides(V3d(frame.to_scene(occluder.positions[vertex]))))
                return false;
    }
    return !occluder.strands
        || for_points(*occluder.strands, frame, [&](const SceneBox& box) { return --left >= 0 && horizon.hides(box); });
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
    if (mesh.strands)
        for_points(*mesh.strands, frame, [&](const SceneBox& point) {
            box.add(point);
            return true;
        });
    return box;
}

CasterReach find_reach(const Mesh& mesh, const Mesh& occluder, const SceneFrame& frame, const SceneChoice& choice)
{
    CasterReach found;
    found.name = occluder.name;
    found.triangles = int64_t(occluder.triangles.size()) + (occluder.instances ? occluder.instances->triangles() : 0);
    if (occluder.strands) {
        found.strands = int64_t(occluder.strands->count());
        found.spans = int64_t(occluder.strands->points.size()) - found.strands;
    }
    SceneBox box = scene_box(occluder, frame);
    const std::vector<SceneBox> instances = instance_boxes(occluder, frame);
    for (const SceneBox& instance : instances)
        box.add(instance);
    const double gap = found.triangles + found.strands == 0 ? 0 : std::sqrt(box.distance2(scene_box(mesh, frame)));
    found.gap = gap / frame.scale;
    // Ray origins are off the surface, and boxes and lengths are floats.
    if (gap > choice.reach * frame.scale * (1 + 1e-5) + 4 * kRayOffset)
        found.verdict = CasterReach::too_far;
    else if (is_below_horizon(mesh, occluder, instances, box, frame, found.tests))
        found.verdict = CasterReach::below_horizon;
    return found;
}

} // namespace vmlight
