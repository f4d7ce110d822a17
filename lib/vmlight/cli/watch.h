// SPDX-License-Identifier: Apache-2.0
/// --watch: an executable that stays up and makes its image again whenever a file that it read changes.
#pragma once

#include <vmlight/base/file_stamp.h>
#include <vmlight/base/stopwatch.h>
#include <vmlight/cli/main.h>

#include <functional>
#include <set>
#include <string>
#include <vector>

namespace vmlight {

/// What one process keeps from image to image. The command line is parsed anew for each, since a recipe in it may have
/// changed: begin with a StageMain of its own, add_flag(), and call made() at the end of the work.
class Watch
{
public:
    /// Adds the flag. `stage` must not outlive this.
    void add_flag(StageMain& stage);
    bool is_given() const { return m_is_given; }

    /// For StageMain's work: why `output` cannot be written, or "". It is a file that was read.
    std::string output_fault(const std::string& output) const;
    /// For StageMain's work: `output` is written. Prints what changed and how long it took, or, the first time, what is
    /// watched.
    void made(const StageMain& stage, const std::string& output);

    /// Run `once`, which returns an exit code; with --watch again after each change, if the first succeeds. What fails
    /// later has said so, leaves the old image, and is made once a file changes again.
    ///
    /// @returns the exit code; with --watch, that of the first image or of an interrupt
    int run(const std::function<int()>& once);

private:
    std::vector<std::string> changed_files() const;

    bool m_is_given = false, m_is_again = false;
    std::set<std::string> m_warned;
    std::vector<std::string> m_changed;
    std::vector<FileStamp> m_files; // that the last image was made of
    Stopwatch m_timer;
    std::string m_name;
};

} // namespace vmlight
