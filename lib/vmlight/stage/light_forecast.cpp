// SPDX-License-Identifier: Apache-2.0
#include <vmlight/stage/light_forecast.h>

#include <vmlight/base/format.h>
#include <vmlight/base/stopwatch.h>
#include <vmlight/base/text_format.h>
#include <vmlight/base/work_counts.h>

#include <ctime>

namespace vmlight {
namespace {

// Colour that varies is harder to compress than visibility. Measured on lightmaps of 256 and 1024, two thirds covered.
constexpr double kColorWrite = 1.3;

} // namespace

bool forecast_light(const LightmapInputs& inputs, const LightmapParams& params, const LightPlan& plan,
                    const TimeTaken& taken, const MakeOptions& options, std::string& error)
{
    const std::clock_t begin = std::clock();
    OIIO::ImageBuf lightmap;
    Stopwatch timer;
    if (!make_lightmap(lightmap, inputs, params, options, error))
        return false;
    // In fresh memory, which costs as much as the light; other frames reuse it.
    const double first = timer.lap();
    if (!make_lightmap(lightmap, inputs, params, options, error))
        return false;
    const double next = timer.lap();
    const double read = taken.read + plan.next_read * double(plan.frames - 1),
                 light = first + next * double(plan.frames - 1);
    const double write = write_seconds(lightmap.spec(), options.threads) * kColorWrite * double(plan.frames);
    const TimeTaken all { 0, taken.processor + double(std::clock() - begin) / CLOCKS_PER_SEC };
    const double start = options.forecasts ? options.forecasts->start(all) : start_seconds(all);
    const double seconds = start + read + light + write,
                 bytes = expected_bytes(0.5 * double(lightmap.spec().image_bytes()));
    if (options.forecasts)
        options.forecasts->add(seconds, bytes);
    options.report_answer(
        format("expected: {:.2f} s: start {:.2f} s, read and filter {:.2f} s, light {:.2f} s, {} {:.2f} s; "
               "{:.0f} MB of memory",
               seconds, start, read, light, count_text(int64_t(plan.frames), "file", "files"), write, bytes / 1e6));
    return true;
}

LightWork LightWork::so_far()
{
    const WorkCounts& counts = work_counts();
    return { counts.filter_passes,    counts.texels_looked_up, counts.texels_multiplied,
             counts.pixels_converted, counts.sun_rays,         counts.bounce_rays };
}

void report_taken(const LightWork& before, const MakeOptions& options)
{
    const LightWork now = LightWork::so_far();
    options.report_answer(
        format("took: {} over the environment; {:.3f} M texels looked light up, {:.3f} M were multiplied by an albedo; "
               "{:.3f} M pixels changed their colour space",
               count_text(now.filter_passes - before.filter_passes, "pass of a filter", "passes of filters"),
               double(now.looked_up - before.looked_up) * 1e-6, double(now.multiplied - before.multiplied) * 1e-6,
               double(now.converted - before.converted) * 1e-6));
    if (const int64_t rays = now.sun_rays - before.sun_rays; rays > 0)
        options.report_answer(format("  suns: {:.3f} M rays", double(rays) * 1e-6));
    if (const int64_t rays = now.bounce_rays - before.bounce_rays; rays > 0)
        options.report_answer(format("  bounce: {:.3f} M rays", double(rays) * 1e-6));
}

} // namespace vmlight
