// SPDX-License-Identifier: Apache-2.0
#include "gnuplot.h"

#include <vmlight/base/format.h>

#include <array>
#include <cerrno>
#include <cstdio>
#include <cstring>

namespace vmlight::cost {
namespace {

// Returns the exit code, -1 if the command cannot be started.
int run(const std::string& command, std::string& output)
{
    std::FILE* pipe = ::popen(command.c_str(), "r");
    if (!pipe)
        return -1;
    std::array<char, 4096> part;
    for (size_t count; (count = std::fread(part.data(), 1, part.size(), pipe)) > 0;)
        output.append(part.data(), count);
    return ::pclose(pipe);
}

} // namespace

std::string gnuplot_fault()
{
    std::string ignored;
    return run("exec gnuplot --version 2>/dev/null", ignored) == 0
        ? ""
        : "gnuplot is missing: install the package gnuplot-nox, or pass --no-plots";
}

bool run_gnuplot(std::string& output, const std::string& script, std::string& error)
{
    output.clear();
    // An unnamed file: no path to quote, and no debris after an interrupt.
    std::FILE* file = std::tmpfile();
    if (!file || std::fwrite(script.data(), 1, script.size(), file) != script.size() || std::fflush(file) != 0)
        error = format("cannot write a script for gnuplot: {}", std::strerror(errno));
    if (error.empty()) {
        std::rewind(file);
        const int code = run(format("exec gnuplot - </dev/fd/{}", ::fileno(file)), output);
        if (code != 0 || output.empty())
            error = format("gnuplot failed with exit code {}", code);
    }
    if (file)
        std::fclose(file);
    return error.empty();
}

} // namespace vmlight::cost
