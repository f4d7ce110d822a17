// SPDX-License-Identifier: Apache-2.0
#include <vmlight/vismap/sample_count.h>

#include <vmlight/base/format.h>
#include <vmlight/base/stopwatch.h>
#include <vmlight/vismap/pilot.h>
#include <vmlight/vismap/reconstruct.h>
#include <vmlight/vismap/reconstruct_pilot.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <memory>

namespace vmlight {
namespace {

constexpr int kFirst = 64, kMost = 1 << 20;
// The error is known to a few per cent only: closer counts are equally good.
constexpr double kNear = 1.04;
// Texels that are enough to scale Visibility::error, and one of how many at most.
constexpr int64_t kScaleTexels = 1024, kScaleStep = 16;
// All of fewer texels may agree by chance.
constexpr int64_t kTelling = 256;

// error ~ samples^-0.75, the rate of all samplers.
double samples_for(const PilotError& known, double target)
{
    return known.samples * std::pow(known.rms / target, 1 / 0.75);
}

double error_at(int samples, const PilotError& known)
{
    return known.rms * std::pow(double(known.samples) / samples, 0.75);
}

int to_count(double samples, double least, double most)
{
    return int(std::ceil(std::min(std::max(samples, least), most)));
}

// A count between one that misses the target and one that reaches it; both excluded, by kNear where there is room.
int between(const PilotError& misses, const PilotError& reaches, double target, bool halve)
{
    double share = 0.5;
    if (reaches.rms > 0 && misses.rms > target && !halve)
        share = std::log(misses.rms / target) / std::log(misses.rms / reaches.rms);
    const double samples = misses.samples * std::pow(double(reaches.samples) / misses.samples, share);
    const int low = misses.samples + 1, high = reaches.samples - 1;
    return std::min(std::max(to_count(samples, misses.samples * kNear, reaches.samples / kNear), low), high);
}

enum class Outcome
{
    Done,
    Stopped,
    OutOfReach
};

// The error at a number of rays; false if stopped.
using Measure = std::function<bool(int samples, PilotError& dst)>;

// `dst` is the lowest count that reaches the target, or the highest that was tried.
Outcome reach(PilotError& dst, int64_t texels, const Measure& measure, double target, int least)
{
    PilotError misses, reaches; // samples 0: none yet
    int samples = kFirst;
    bool still = false; // nothing scatters
    for (int tries = 1;; ++tries) {
        if (!measure(samples, dst))
            return Outcome::Stopped;
        if (tries == 1 && dst.rms == 0) {
            still = texels == 0 || texels >= kTelling;
            least = still ? least : samples;
        }
        // A few rays may agree by chance.
        const bool by_chance = dst.rms == 0 && samples < kFirst && !still;
        (dst.rms <= target && !by_chance ? reaches : misses) = dst;
        if (reaches.samples && (reaches.samples == least || reaches.samples - 1 <= misses.samples * kNear)) {
            dst = reaches;
            return Outcome::Done;
        }
        if (misses.samples == kMost || (!reaches.samples && samples > kFirst && error_at(kMost, misses) > 2 * target))
            return Outcome::OutOfReach;
        if (!reaches.samples) // no farther in one step than the rate can be trusted
            samples = to_count(samples_for(misses, target), samples * kNear, std::min(kMost, samples * kFirst));
        else if (!misses.samples)
            samples = reaches.rms > 0
                ? std::min(to_count(samples_for(reaches, target), least, samples / kNear), samples - 1)
                : least;
        else
            // Some counts are better than their neighbours: following the rate may never converge.
            samples = between(misses, reaches, target, tries > 6);
    }
}

// Seconds per texel and ray on all threads, from runs that grow until they are long enough to time.
bool time_rays(double& seconds, const VismapPilot& pilot, double time_budget)
{
    PilotError timed;
    for (int samples = 16;; samples *= 4) {
        if (!pilot.measure(samples, timed, true))
            return false;
        seconds = timed.seconds / double(2 * pilot.texels() * samples);
        if (timed.seconds >= std::min(0.1, time_budget / 20) || samples >= kMost)
            return true;
    }
}

} // namespace

bool choose_samples(SampleCount& dst, const BakeScene& scene, const NormalMap* normal_map, const UvRaster& raster,
                    const OpenTriangles& open, const SeamLinks& seams, const VismapParams& params, double time_budget,
                    int nthreads, const Progress& progress, std::string& error)
{
    dst = {};
    dst.samples = params.samples;
    const double target = params.target_error;
    const bool reconstructs = is_reconstructed(params) && !normal_map;
    const bool wants_error = target > 0 || time_budget > 0 || params.has("error");
    if (!wants_error && !reconstructs)
        return true;
    const auto stopped = [&] {
        error = "interrupted";
        return false;
    };
    // One ray has no scatter.
    const int least = params.has("error") || reconstructs ? 2 : 1;
    if (target <= 0 && time_budget <= 0 && params.samples < least) {
        error = "samples: 1 is too few for the channel error, which needs 2";
        return false;
    }
    const Stopwatch timer;
    // Visibility::error is scaled by texels of its own, so that measuring the error changes nothing else.
    VismapPilot pilot(scene, normal_map, params, nthreads, progress);
    VismapPilot scatter(scene, normal_map, params, nthreads, progress);
    ReconstructPilot windows(scene, pilot, params, nthreads, progress);
    if ((wants_error && !pilot.pick(raster, open))
        || (reconstructs && !scatter.pick(raster, open, kScaleTexels, kScaleStep))
        || (wants_error && reconstructs && !windows.pick(raster, open, seams)))
        return stopped();
    double pattern = 0, error_scale = 1; // of the last measurement
    const Measure measure = [&](int samples, PilotError& error_there) {
        if (reconstructs) {
            if (!scatter.measure(samples, error_there))
                return false;
            pattern = pattern_error(error_there, scatter.texels());
        }
        if (!wants_error)
            return true;
        if (!pilot.measure(samples, error_there))
            return false;
        ReconstructError reconstructed;
        if (!reconstructs)
            return true;
        if (!windows.measure(error_there, pattern, reconstructed))
            return false;
        error_there.rms = reconstructed.rms;
        error_scale = reconstructed.scale;
        return true;
    };
    PilotError measured;
    if (target > 0) {
        const Outcome outcome = reach(measured, pilot.texels(), measure, target, least);
        if (outcome == Outcome::Stopped)
            return stopped();
        if (outcome == Outcome::OutOfReach) {
            error = format("target_error: {:.6g} is out of reach: {} rays per texel give {:.2g}", target, kMost,
                           error_at(kMost, measured));
            return false;
        }
    } else {
        int samples = params.samples;
        if (time_budget > 0) {
            double seconds = 0;
            if (pilot.texels() > 0 && !time_rays(seconds, pilot, time_budget))
                return stopped();
            // The error is measured at the same count, and takes its share of the time.
            const double measured_texels = double(2 * pilot.texels())
                + (reconstructs ? double(2 * scatter.texels() + windows.traced_texels()) : 0);
            const double baked = double(pilot.covered());
            const double fitting = time_budget / (seconds * (baked + measured_texels));
            samples = seconds > 0 ? std::max(least, int(std::min(fitting, double(kMost)))) : least;
            dst.bake_seconds = seconds * baked * samples;
        }
        if (!measure(samples, measured))
            return stopped();
    }
    dst.samples = measured.samples;
    if (reconstructs && target > 0 && !measure(dst.samples, measured)) // the last try may have been another count
        return stopped();
    dst.pilot_seconds = timer();
    if (!reconstructs && measured.scatter_rms > 0)
        dst.scatter_scale = measured.rms / measured.scatter_rms;
    dst.pattern_error = pattern;
    dst.error_scale = error_scale;
    if (!wants_error)
        return true;
    dst.rms = measured.rms;
    dst.texels = pilot.texels();
    return true;
}

} // namespace vmlight
