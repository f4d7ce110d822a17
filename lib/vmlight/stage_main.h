// SPDX-License-Identifier: Apache-2.0
/// What every stage's executable shares: flags made from params, progress, messages, exit codes. A main declares what
/// it takes, then gives the work.
#pragma once

#include <vmlight/export.h>
#include <vmlight/params.h>
#include <vmlight/progress.h>

#include <OpenImageIO/imagebuf.h>

#include <functional>
#include <memory>
#include <string>
#include <vector>

namespace vmlight {

/// Exit codes of all executables.
enum class Exit
{
    Done = 0,
    Failed = 1,
    Usage = 2
};

class VMLIGHT_API StageMain
{
public:
    /// @param name     of the executable
    /// @param purpose  one sentence
    /// @param operands names of the positional arguments, all of which are needed
    /// @param example  one or more command lines
    StageMain(std::string name, std::string purpose, std::vector<std::string> operands, std::string example);
    ~StageMain();

    /// A flag for each parameter: `--max-distance 2` for `max_distance`, with `prefix` before its name.
    /// `params` must outlive run().
    template <class Params> void params(const char* heading, Params& params, const std::string& prefix = "")
    {
        group(heading);
        Params defaults = params;
        defaults.visit([&](const char* field, auto& value, const auto& allowed, const char* help) {
            const std::string name = field, text = value_text(value, allowed);
            const bool is_flag = std::is_same_v<std::decay_t<decltype(allowed)>, Flag>;
            option(prefix + name, is_flag ? "" : allowed_text(allowed),
                   text.empty() || is_flag ? help : help + (" [" + text + "]"),
                   [&params, name](OIIO::string_view given, std::string& error) {
                       return set_param(params, name, given, error);
                   });
        });
    }
    /// Takes the flag's value ("true" for one without); false and `error` refuse it. A flag may come more than once.
    using Take = std::function<bool(OIIO::string_view text, std::string& error)>;
    void group(const std::string& heading);
    void option(const std::string& name, const std::string& metavar, const std::string& help, Take take);
    /// An option whose text is kept as it is; `dst` must outlive run().
    void option(const std::string& name, const std::string& metavar, const std::string& help, std::string& dst);

    /// Parse the command line, then call `work`, which returns false and sets `error` on failure. Catches exceptions.
    /// @returns the process's exit code.
    int run(int argc, const char** argv, const std::function<bool(std::string& error)>& work);

    // For `work`.
    const std::string& operand(size_t index) const;
    const std::string& output() const;
    int threads() const;
    /// A progress line for one step of the work, on stderr; stops the work when the user interrupts.
    Progress progress(const std::string& step);
    /// One line on stdout, unless --quiet.
    void say(const std::string& line) const;
    /// One line on stderr: the result is right, but may surprise.
    void warn(const std::string& line) const;
    /// Write to output() (or `path`) in the format the user asked for.
    bool write(const OIIO::ImageBuf& image, std::string& error);
    bool write(const OIIO::ImageBuf& image, const std::string& path, std::string& error);

private:
    struct State;
    std::unique_ptr<State> m_state;
};

} // namespace vmlight
