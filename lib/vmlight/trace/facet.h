// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vmlight/trace/bake_scene.h>
#include <vmlight/trace/horizon.h>

#include <array>
#include <cstdint>

namespace vmlight {

/// A triangle of the baked mesh, as it is traced.
struct Facet
{
    Facet(const BakeScene& scene, uint32_t triangle)
        : normal(surface_normal(scene.mesh(), scene.mesh().triangles[triangle]))
    {
        for (size_t k = 0; k < 3; ++k) {
            const Imath::V3f corner
                = scene.frame().to_scene(scene.mesh().positions[scene.mesh().triangles[triangle][k]]);
            corners[k] = Imath::V3d(corner);
            box.add(corner);
        }
    }
    bool has_area() const { return normal.length2() > 0.5; }
    Horizon horizon() const { return { corners, normal }; }

    Imath::V3d normal;
    std::array<Imath::V3d, 3> corners;
    SceneBox box;
};

} // namespace vmlight
