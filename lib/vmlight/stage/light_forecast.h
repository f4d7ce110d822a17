// SPDX-License-Identifier: Apache-2.0
/// What lighting maps is going to take: --dry-run of makelightmap; and what it took.
#pragma once

#include <vmlight/base/export.h>
#include <vmlight/lightmap/lightmap.h>
#include <vmlight/stage/forecast_costs.h>
#include <vmlight/stage/make_options.h>
#include <vmlight/stage/make_stage.h>

#include <cstdint>
#include <string>

namespace vmlight {

/// How many lightmaps are made, and how many seconds it takes to read what the inputs of each but the first have of
/// their own.
struct LightPlan
{
    size_t frames = 1;
    double next_read = 0;
};

/// Report the expected time and memory of lightmaps of these inputs, from the start of the process to its end; lights
/// one of them, twice, to find out. False, with the reason in `error`, as make_lightmap().
VMLIGHT_API bool forecast_light(const LightmapInputs& inputs, const LightmapParams& params, const LightPlan& plan,
                                const TimeTaken& taken, const MakeOptions& options, std::string& error);

/// Work done since the process started.
struct LightWork
{
    int64_t filter_passes = 0, looked_up = 0, multiplied = 0, converted = 0, sun_rays = 0, bounce_rays = 0;

    VMLIGHT_API static LightWork so_far();
};

/// Report what was done since `before`.
VMLIGHT_API void report_taken(const LightWork& before, const MakeOptions& options);

} // namespace vmlight
