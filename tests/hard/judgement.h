// SPDX-License-Identifier: Apache-2.0
/// How many texels of a map are not what a scene without any doubt asks for.
#pragma once

#include "baked_map.h"

#include <cstdint>

namespace vmlight {

inline bool sees_all(const Texel& t)
{
    return t.visibility == 1;
}

inline bool sees_nothing(const Texel& t)
{
    return t.is_zero();
}

inline bool is_finite(const Texel& t)
{
    return std::isfinite(t.visibility) && std::isfinite(t.direction.x) && std::isfinite(t.direction.y)
        && std::isfinite(t.direction.z);
}

/// Of a mesh that covers an eighth of its texture or more, inside something closed.
inline int64_t texels_that_see(const Mesh& mesh, int size, int samples)
{
    const BakedMap map(mesh, {}, map_params(size, size, samples, "sobol"));
    EXPECT_GT(map.report.covered, size * size / 8);
    return count_covered_unless(map, sees_nothing);
}

/// The same, outside of something convex.
inline int64_t texels_that_see_less_than_all(const Mesh& mesh, int size, int samples)
{
    const BakedMap map(mesh, {}, map_params(size, size, samples, "sobol"));
    EXPECT_GT(map.report.covered, size * size / 8);
    return count_covered_unless(map, sees_all);
}

} // namespace vmlight
