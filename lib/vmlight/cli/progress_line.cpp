// SPDX-License-Identifier: Apache-2.0
#include <vmlight/cli/progress_line.h>

#include <vmlight/base/format.h>
#include <vmlight/base/stopwatch.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <cstdio>
#include <memory>

#include <unistd.h>

namespace vmlight {
namespace {

std::atomic<bool> s_line_is_open { false };

std::string rate_text(double rate)
{
    struct
    {
        double threshold;
        const char* prefix;
    } constexpr kScales[] { { 1e9, "G " }, { 1e6, "M " }, { 1e3, "k " } };
    for (const auto& [threshold, prefix] : kScales)
        if (rate >= 0.9995 * threshold) { // three digits never round to 1000
            const double scaled = rate / threshold;
            return format("{:.{}f} {}", scaled, scaled < 9.995 ? 2 : scaled < 99.95 ? 1 : 0, prefix);
        }
    return format("{:.0f} ", rate);
}

std::string time_text(double seconds)
{
    if (!(seconds < 360000))
        return "--:--";
    const int whole = int(std::ceil(seconds));
    return whole < 3600 ? format("{:02}:{:02}", whole / 60, whole % 60)
                        : format("{}:{:02}:{:02}", whole / 3600, whole / 60 % 60, whole % 60);
}

} // namespace

std::string progress_line(const std::string& step, double done, double seconds, int64_t texels)
{
    if (texels == 0 && done == 0)
        return step + " ...";
    const double rate = seconds > 0 ? done * double(texels) / seconds : 0;
    const std::string speed = texels > 0 ? rate_text(rate) + "texels/s  " : "";
    const std::string time = done >= 1 ? time_text(seconds) : time_text(seconds / done - seconds) + " left";
    return format("{} {:3.0f} %  {}{}", step, std::floor(100 * done), speed, time);
}

Progress progress_on_stderr(const std::string& step, int64_t texels, std::function<bool()> keep_going)
{
    const bool terminal = ::isatty(STDERR_FILENO) != 0;
    auto timer = std::make_shared<Stopwatch>();
    auto last = std::make_shared<double>(-1); // seconds on a terminal, tenths elsewhere
    return [=](double done) {
        const double seconds = (*timer)();
        const std::string line = progress_line(step, done, seconds, texels);
        if (terminal && (seconds - *last > 0.1 || done >= 1)) {
            *last = seconds;
            // Padded, to overwrite a longer line.
            std::fprintf(stderr, "\r%-56s%s", line.c_str(), done >= 1 ? "\n" : "");
            s_line_is_open = done < 1;
        } else if (!terminal && int(10 * done) > *last && seconds > 1) {
            *last = int(10 * done);
            std::fprintf(stderr, "%s\n", line.c_str());
        }
        return keep_going();
    };
}

void end_progress_line()
{
    if (s_line_is_open.exchange(false))
        std::fputc('\n', stderr);
}

} // namespace vmlight
