// SPDX-License-Identifier: Apache-2.0
#include <vmlight/stage/forecast_costs.h>

#include <vmlight/base/format.h>
#include <vmlight/base/parallel.h>

#include <OpenImageIO/strutil.h>
#include <OpenImageIO/sysutil.h>

#include <algorithm>
#include <ctime>
#include <fstream>
#include <string>

namespace vmlight {
namespace {

// CPU seconds per texel and channel, to compress the file on all threads. Measured on maps of 1024 and 2048, half
// covered.
constexpr double kWriteSeconds = 100e-9;

// The most that the process has held so far; 0 if that is not known.
double peak_bytes()
{
    std::ifstream status("/proc/self/status");
    for (std::string line; std::getline(status, line);)
        if (OIIO::Strutil::starts_with(line, "VmHWM:"))
            return 1024.0 * double(OIIO::Strutil::stoi(line.substr(6)));
    return 0;
}

double values_of(const OIIO::ImageSpec& spec)
{
    return double(spec.image_pixels()) * spec.nchannels;
}

} // namespace

double write_seconds(const OIIO::ImageSpec& spec, int nthreads)
{
    return values_of(spec) * kWriteSeconds / worker_count(nthreads);
}

double start_seconds(const TimeTaken& taken)
{
    // On a machine with time to spare a process has used its processor since it was started.
    return std::max(0.0, double(std::clock()) / CLOCKS_PER_SEC - taken.processor);
}

double Forecasts::start(const TimeTaken& taken)
{
    const double seconds = m_started ? 0 : start_seconds(taken);
    m_started = true;
    return seconds;
}

void Forecasts::add(double seconds, double bytes)
{
    ++m_count;
    m_seconds += seconds;
    m_bytes = std::max(m_bytes, bytes);
}

std::string Forecasts::text() const
{
    return m_count > 1 ? format("expected in all: {:.2f} s; {:.0f} MB of memory", m_seconds, m_bytes / 1e6) : "";
}

double expected_bytes(double more)
{
    const double held = double(OIIO::Sysutil::memory_used(true));
    return std::max(peak_bytes(), held + more);
}

} // namespace vmlight
