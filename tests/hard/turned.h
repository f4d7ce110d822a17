// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "scenes.h"

namespace vmlight::scenes {

/// A mesh turned out of all planes and axes that floats favour.
inline Mesh turned(Mesh mesh)
{
    const V3d z = V3d(0.61, -0.33, 0.72).normalized(), x = z.cross(V3d(0.2, 0.1, 1)).normalized(), y = z.cross(x);
    for (V3d& p : mesh.positions)
        p = x * p.x + y * p.y + z * p.z;
    for (V3f& n : mesh.normals)
        n = V3f(x * n.x + y * n.y + z * n.z);
    return mesh;
}

} // namespace vmlight::scenes
