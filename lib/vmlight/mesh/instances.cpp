// SPDX-License-Identifier: Apache-2.0
#include <vmlight/mesh/instances.h>

#include <vmlight/base/format.h>

#include <cmath>
#include <utility>

namespace vmlight {
namespace {

using Imath::M44d;
using Imath::V3d;
using Imath::V3f;

bool is_finite(const M44d& matrix)
{
    for (int row = 0; row < 4; ++row)
        for (int column = 0; column < 4; ++column)
            if (!std::isfinite(matrix[row][column]))
                return false;
    return true;
}

} // namespace

int64_t MeshInstances::triangles() const
{
    int64_t sum = 0;
    for (const Place& place : places)
        sum += int64_t(meshes[place.mesh].triangles.size());
    return sum;
}

int64_t MeshInstances::distinct_triangles() const
{
    int64_t sum = 0;
    for (const Mesh& mesh : meshes)
        sum += int64_t(mesh.triangles.size());
    return sum;
}

Mesh placed_mesh(const Mesh& mesh, const M44d& to_object)
{
    Mesh placed = mesh;
    const M44d normals_to_object = to_object.inverse().transposed();
    for (V3d& position : placed.positions)
        to_object.multVecMatrix(V3d(position), position);
    for (V3f& normal : placed.normals) {
        V3d turned;
        normals_to_object.multDirMatrix(V3d(normal), turned);
        normal = V3f(turned.normalized());
    }
    if (to_object.determinant() < 0)
        for (auto& triangle : placed.triangles)
            std::swap(triangle[1], triangle[2]);
    return placed;
}

bool check_instances(const Mesh& mesh, std::string& error)
{
    if (!mesh.instances)
        return true;
    for (const Mesh& distinct : mesh.instances->meshes)
        if (!check_mesh(distinct, error))
            return false;
    const auto& places = mesh.instances->places;
    for (size_t i = 0; i < places.size(); ++i) {
        const bool exists = places[i].mesh < mesh.instances->meshes.size();
        if (exists && is_finite(places[i].to_object))
            continue;
        error = format("\"{}\": instance {} has {}", mesh.path.empty() ? mesh.name : mesh.path, i,
                       exists ? "a transform that is not finite" : "a mesh that does not exist");
        return false;
    }
    return true;
}

int64_t held_triangles(const Mesh& mesh)
{
    return int64_t(mesh.triangles.size()) + (mesh.instances ? mesh.instances->distinct_triangles() : 0);
}

} // namespace vmlight
