// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vmlight/base/progress.h>

#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <vector>

namespace vmlight {

class BakeScene;
class Forecasts;
class PoseSequence;

/// How to make a stage: threads, and where progress and messages go.
struct MakeOptions
{
    /// Names of the recipes being made, outermost first; the last is the one whose struct is given. Empty if the recipe
    /// has no file. Error messages name it, and none of them may be read again.
    std::vector<std::string> chain;
    /// 0 means OIIO's default.
    int threads = 0;
    /// Returns the progress of one step of the work ("bake", "filter", "light"), which makes an image of `texels`.
    std::function<Progress(const std::string& step, int64_t texels)> progress;
    /// Receive a line of information, or a warning.
    std::function<void(const std::string&)> say, warn;
    /// Receives the lines that `explain` and `dry_run` ask for; if empty, say() does.
    std::function<void(const std::string&)> answer;
    /// Say which effects run and why, before the work and after it; or instead of it, with time and memory expected.
    bool explain = false, dry_run = false;
    /// nullptr, or adds up the forecasts of a dry run.
    Forecasts* forecasts = nullptr;
    /// Whether the image will be stored as half.
    bool half = false;
    /// nullptr, or keeps the mesh and the ray-tracing scene of the last vismap for the next call to share.
    std::shared_ptr<const BakeScene>* scene = nullptr;
    /// nullptr, or the poses of a mesh so far, for the map of the next to keep texels of; the name of the one to make;
    /// and how many there are of the mesh in all.
    PoseSequence* poses = nullptr;
    std::string pose;
    int64_t pose_count = 1;
    /// The same inputs were made for another UDIM tile before: do not repeat what holds for all tiles.
    bool repeated_inputs = false;
    /// The same for another part of the mesh.
    bool repeated_mesh = false;

    /// progress() for an image of `width` x `height` texels; empty if there is no listener.
    Progress step(const char* name, int64_t width, int64_t height) const
    {
        return progress ? progress(name, width * height) : Progress {};
    }
    /// Shows the name of each step that has no progress of its own.
    StepListener steps() const
    {
        if (!progress)
            return {};
        return [listen = progress](const char* name) { listen(name, 0)(0); };
    }
    /// say() or warn(), if set.
    void report(const std::string& line) const
    {
        if (say)
            say(line);
    }
    /// A line that `explain` or `dry_run` asked for.
    void report_answer(const std::string& line) const
    {
        if (answer)
            answer(line);
        else
            report(line);
    }
    void report_warning(const std::string& line) const
    {
        if (warn)
            warn(line);
    }
};

} // namespace vmlight
