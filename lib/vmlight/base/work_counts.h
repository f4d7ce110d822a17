// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <cstdint>

namespace vmlight {

/// What was done since the process began, by readers and for recipes, for tests that hold them to doing it once.
struct WorkCounts
{
    std::atomic<int64_t> meshes_read { 0 };
    std::atomic<int64_t> scenes_built { 0 }; ///< for the ray tracer
    std::atomic<int64_t> tiles_baked { 0 }; ///< those with a covered texel
    std::atomic<int64_t> cfems_made { 0 };
    std::atomic<int64_t> albedos_made { 0 };
    std::atomic<int64_t> tiles_shaded { 0 };
};
WorkCounts& work_counts();

} // namespace vmlight
