// SPDX-License-Identifier: Apache-2.0
/// Maps and environments for the models that know more of the sky than V and B tell: sh, mask, cells.
#pragma once

#include "lightmap_scene.h"
#include "scenes.h"

#include <vmlight/vismap/vismap.h>

#include <gtest/gtest.h>

#include <functional>

namespace scene::basis_maps {

inline constexpr const char* kModels[] = { "sh", "mask", "cells" };

/// A floor with a wall beside it and a roof over a part: texels that see all, half and little.
inline ImageBuf basis_map(const char* basis, int samples = 256, int side = 24)
{
    const vmlight::Mesh floor = vmlight::scenes::floor_facing_z(2);
    const vmlight::Mesh wall = vmlight::scenes::quad({ 2.01, -9, 0 }, { 2.01, 9, 0 }, { 2.01, 9, 3 }, { 2.01, -9, 3 });
    const vmlight::Mesh roof = vmlight::scenes::quad({ -3, -3, 0.5 }, { -1, -3, 0.5 }, { -1, 3, 0.5 }, { -3, 3, 0.5 });
    vmlight::VismapParams params;
    params.resolution = { side, side };
    params.samples = samples;
    params.basis = basis;
    params.margin = 0;
    ImageBuf vm;
    EXPECT_TRUE(vmlight::make_vismap(vm, floor, { wall, roof }, params)) << vm.geterror();
    return vm;
}

/// An environment twice as wide as high.
inline ImageBuf painted_by(const std::function<V3f(V3d direction)>& light, int width = 64)
{
    return cfem(width, width / 2, light);
}

} // namespace scene::basis_maps
