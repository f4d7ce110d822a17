// SPDX-License-Identifier: Apache-2.0
/// A map from whatever bakes its texels.
#pragma once

#include <vmlight/vismap/baker.h>
#include <vmlight/vismap/map_rows.h>
#include <vmlight/vismap/reconstruct.h>

#include <OpenImageIO/imagebuf.h>

#include <functional>

namespace vmlight {

/// What make_vismap() is asked for.
struct MapJob
{
    BakeScenePointer scene;
    VismapParams params;
    int nthreads = 0;
    Progress progress;
    double time_budget = 0;
    NormalMapPointer normal_map;
    StepListener at_step {}; ///< hears of the steps before and after those of `progress`
    bool in_bands = false; ///< memory for some rows of tiles is enough: for stream_map() and parts
};

/// A map without its margin.
struct BakedTexels
{
    float* pixels;
    Coverage coverage;
    BakeCounts counts;
    TexelContexts contexts; ///< empty if the map is not reconstructed
};

/// The same job, telling its progress to another.
inline MapJob with_progress(MapJob job, const Progress& progress)
{
    job.progress = progress;
    return job;
}

/// Set all covered texels of the map, their coverage, counts and contexts. False if `progress` stopped it.
using BakeTexels = std::function<bool(const VismapBaker& baker, const Progress& progress, BakedTexels& dst)>;

/// Prepare the baker of a job, and describe its map.
///
/// @param report   set to what is known before the bake
/// @param islands  whether to count UV islands for it
/// @returns false, with the reason in `error`, as make_vismap()
bool prepare_map(VismapBaker& baker, OIIO::ImageSpec& spec, VismapReport& report, const MapJob& job, bool islands,
                 std::string& error);

/// Add what a bake counted to its report.
void count_baked(VismapReport& report, const BakeCounts& baked);

/// make_vismap(), with the texels of `bake`.
bool make_map(OIIO::ImageBuf& dst, const MapJob& job, const BakeTexels& bake, VismapReport* report);

/// make_vismap(), bit for bit, without the whole map in memory, unless its margin is not MarginRows::is_narrow().
/// False, with the reason in `error`, also if `rows` returned it.
bool stream_map(const MapRows& rows, const MapJob& job, VismapReport& report, std::string& error);

} // namespace vmlight
