// SPDX-License-Identifier: Apache-2.0
/// Meshes of instances, and where these are.
#pragma once

#include "scenes.h"

#include <vmlight/mesh/instances.h>

#include <Imath/ImathMatrix.h>

#include <cmath>
#include <memory>
#include <random>
#include <vector>

namespace vmlight::scenes {

using Imath::M44d;

/// A mesh that has another one at each of `places`.
inline Mesh with_places(const Mesh& distinct, const std::vector<M44d>& places)
{
    Mesh mesh;
    mesh.name = "places";
    mesh.instances = std::make_shared<MeshInstances>();
    mesh.instances->meshes = { distinct };
    for (const M44d& place : places)
        mesh.instances->places.push_back({ 0, place });
    return mesh;
}

/// Scaled, then turned about x, y and z, then moved.
inline M44d placed_at(const V3d& scale, const V3d& degrees, const V3d& offset)
{
    const V3d radians = degrees * (M_PI / 180);
    return M44d().setScale(scale) * M44d().rotate(V3d(radians.x, 0, 0)) * M44d().rotate(V3d(0, radians.y, 0))
        * M44d().rotate(V3d(0, 0, radians.z)) * M44d().setTranslation(offset);
}

/// Turned, scaled unevenly, every third mirrored.
inline std::vector<M44d> random_places(int count, double size)
{
    std::mt19937 random(5);
    std::uniform_real_distribution<double> number(-1, 1);
    std::vector<M44d> places;
    for (int i = 0; i < count; ++i) {
        const double s = size * std::exp2(number(random));
        const V3d scale(s * (i % 3 ? 1 : -1), s * std::exp2(number(random)), s);
        const V3d turn(180 * number(random), 180 * number(random), 180 * number(random));
        places.push_back(placed_at(scale, turn, V3d(number(random), number(random), number(random))));
    }
    return places;
}

} // namespace vmlight::scenes
