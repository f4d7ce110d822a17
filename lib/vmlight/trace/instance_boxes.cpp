// SPDX-License-Identifier: Apache-2.0
#include <vmlight/trace/instance_boxes.h>

#include <vmlight/base/format.h>
#include <vmlight/trace/bake_scene.h>

#include <Imath/ImathBox.h>

#include <algorithm>
#include <array>
#include <cmath>

namespace vmlight {
namespace {

using Imath::V3d;
using Imath::V3f;

std::vector<Imath::Box3d> distinct_boxes(const MeshInstances& instances)
{
    std::vector<Imath::Box3d> boxes(instances.meshes.size());
    for (size_t i = 0; i < boxes.size(); ++i)
        for (const auto& triangle : instances.meshes[i].triangles)
            for (const uint32_t vertex : triangle)
                boxes[i].extendBy(instances.meshes[i].positions[vertex]);
    return boxes;
}

std::array<V3d, 8> corners_of(const Imath::Box3d& box, const Imath::M44d& to_object)
{
    std::array<V3d, 8> corners;
    for (unsigned k = 0; k < 8; ++k)
        to_object.multVecMatrix(
            V3d(k & 1 ? box.max.x : box.min.x, k & 2 ? box.max.y : box.min.y, k & 4 ? box.max.z : box.min.z),
            corners[k]);
    return corners;
}

} // namespace

std::vector<SceneBox> instance_boxes(const Mesh& mesh, const SceneFrame& frame)
{
    std::vector<SceneBox> boxes;
    if (!mesh.instances)
        return boxes;
    const std::vector<Imath::Box3d> distinct = distinct_boxes(*mesh.instances);
    for (const MeshInstances::Place& place : mesh.instances->places) {
        if (distinct[place.mesh].isEmpty())
            continue;
        SceneBox& box = boxes.emplace_back();
        for (const V3d& corner : corners_of(distinct[place.mesh], place.to_object))
            box.add(frame.to_scene(corner));
        // What is traced of it is rounded otherwise.
        const V3f slack = (box.high - box.low) * 1e-6f;
        box.add(box.low - slack);
        box.add(box.high + slack);
    }
    return boxes;
}

bool check_instance_reach(const Mesh& mesh, const SceneFrame& frame, std::string& error)
{
    if (!mesh.instances)
        return true;
    const std::vector<Imath::Box3d> distinct = distinct_boxes(*mesh.instances);
    for (size_t i = 0; i < mesh.instances->places.size(); ++i) {
        const MeshInstances::Place& place = mesh.instances->places[i];
        if (distinct[place.mesh].isEmpty())
            continue;
        for (const V3d& corner : corners_of(distinct[place.mesh], place.to_object)) {
            const double reach = ((corner - frame.centre) * frame.scale).length();
            if (reach <= kFarthestCaster)
                continue;
            error = format("\"{}\": instance {} is {:.2g} times the size of the baked mesh away; rays reach at most "
                           "{:g} times",
                           mesh.path.empty() ? mesh.name : mesh.path, i, reach, kFarthestCaster);
            return false;
        }
    }
    return true;
}

} // namespace vmlight
