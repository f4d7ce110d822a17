// SPDX-License-Identifier: Apache-2.0
#include <vmlight/vismap/bake_parts.h>

#include <vmlight/base/format.h>
#include <vmlight/base/stopwatch.h>
#include <vmlight/vismap/map_part.h>
#include <vmlight/vismap/part_baker.h>

#include <algorithm>

namespace vmlight {
namespace {

// What a map depends on and its metadata do not say.
std::string hash_of_inputs(const MapJob& job)
{
    const std::string& opacity = job.scene->opacity_hashes();
    const bool is_opaque = opacity.find_first_not_of(',') == std::string::npos;
    if (is_opaque && !job.normal_map)
        return "";
    return format("{}/{:016x}", is_opaque ? "" : opacity, job.normal_map ? job.normal_map->hash() : 0);
}

} // namespace

bool bake_parts(const PartsJob& job, VismapReport& report, std::string& error)
{
    VismapBaker baker;
    OIIO::ImageSpec map;
    TileShares shares;
    MapJob whole = job.map;
    whole.in_bands = true; // no part is more than some rows of tiles
    if (!prepare_map(baker, map, report, whole, true, error))
        return false;
    if (!share_tiles(shares, baker, job.count, job.map.nthreads, job.map.progress)) {
        error = "interrupted";
        return false;
    }
    if (job.tag)
        job.tag(map);
    const std::string inputs = hash_of_inputs(job.map);
    const auto describe = [&](int part) {
        return describe_part(map, { part, job.count }, shares.ranges[size_t(part) - 1], inputs);
    };
    std::vector<int> missing;
    PartProgress progress { shares.costs, 0, job.map.progress };
    for (const int part : job.parts) {
        if (job.is_made && job.is_made(part, describe(part)))
            continue;
        missing.push_back(part);
        const TileRange tiles = shares.ranges[size_t(part) - 1];
        for (int tile = tiles.first; tile < tiles.end; ++tile)
            progress.all += shares.costs[size_t(tile)];
    }

    const Stopwatch timer;
    BakeCounts counts;
    PartBaker bakery(baker, int(missing.size()), job.map.nthreads);
    for (const int part : missing) {
        OIIO::ImageBuf image;
        image.reset(describe(part), OIIO::InitializePixels::Yes);
        if (!image.localpixels()) {
            error = format("out of memory for {}x{} texels", image.spec().width, image.spec().height);
            return false;
        }
        if (!bakery.bake(image, shares.ranges[size_t(part) - 1], counts, progress)) {
            error = "interrupted";
            return false;
        }
        if (!job.write(part, image, error))
            return false;
    }
    report.bake_seconds = timer();
    counts.dark = 0; // of some parts it says nothing: who joins them counts it
    count_baked(report, counts);
    report.covered = shares.counts.covered;
    report.overlapping = shares.counts.overlapping;
    return true;
}

} // namespace vmlight
