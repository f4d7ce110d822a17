// SPDX-License-Identifier: Apache-2.0
/// Strands as occluders, in memory.
#pragma once

#include "strand_files.h"

#include <vmlight/mesh/mesh.h>
#include <vmlight/mesh/strands.h>

#include <memory>

namespace vmlight::strand_occluders {

inline Mesh occluder_of(const Strands& strands)
{
    Mesh mesh;
    mesh.name = strands.name;
    mesh.strands = std::make_shared<const Strands>(strands);
    return mesh;
}

/// As good as endless along x, at height z.
inline Strands cylinder(double radius, double z)
{
    return strand_files::straight({ { Imath::V3d(-1e3, 0, z), Imath::V3d(1e3, 0, z) } }, radius, 257);
}

} // namespace vmlight::strand_occluders
