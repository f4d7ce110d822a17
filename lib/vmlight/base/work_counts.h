// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <cstdint>

namespace vmlight {

/// Work done since the process started, so that tests can check that nothing is computed twice.
struct WorkCounts
{
    std::atomic<int64_t> meshes_read { 0 };
    std::atomic<int64_t> scenes_built { 0 }; ///< Embree scenes
    std::atomic<int64_t> tiles_baked { 0 }; ///< tiles with a covered texel
    std::atomic<int64_t> cfems_made { 0 };
    std::atomic<int64_t> albedos_made { 0 };
    std::atomic<int64_t> tiles_shaded { 0 };
    std::atomic<int64_t> alphas_read { 0 }; ///< alpha channels of textures, for cut-outs
    std::atomic<int64_t> filter_passes { 0 }; ///< filters over all of an environment: a stack takes several
    std::atomic<int64_t> texels_looked_up { 0 }; ///< of visibility maps, in the light
    std::atomic<int64_t> texels_multiplied { 0 }; ///< of lightmaps, by an albedo
    std::atomic<int64_t> pixels_converted { 0 }; ///< from one colour space to another
    std::atomic<int64_t> tangents_made { 0 }; ///< meshes whose tangents a normal map needed
    std::atomic<int64_t> margin_texels { 0 }; ///< filled around UV islands
    std::atomic<int64_t> directions_below_ground { 0 }; ///< for which the ground saved a ray
    std::atomic<int64_t> sun_rays { 0 }; ///< rays to suns, from texels
    std::atomic<int64_t> bounce_rays { 0 }; ///< rays that look for surfaces that light a texel
    std::atomic<int64_t> bounces_made { 0 }; ///< times that their light was summed up
};
WorkCounts& work_counts();

} // namespace vmlight
