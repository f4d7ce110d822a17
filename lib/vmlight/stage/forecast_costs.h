// SPDX-License-Identifier: Apache-2.0
/// What every stage takes besides its own work, for --dry-run.
#pragma once

#include <vmlight/base/export.h>

#include <OpenImageIO/imageio.h>

#include <cstdint>
#include <string>

namespace vmlight {

/// Seconds to write an image to a compressed EXR, on so many threads (0: OIIO's default).
double write_seconds(const OIIO::ImageSpec& spec, int nthreads);

/// Seconds since a forecast began: until its inputs were read, and of the processor by all threads.
struct TimeTaken
{
    double read = 0, processor = 0;
};

/// Seconds from the start of the process to that of a forecast that has taken so long.
double start_seconds(const TimeTaken& taken);

/// The forecasts of a run, one for each UDIM tile or material.
class Forecasts
{
public:
    /// start_seconds() of the first; 0 of those after it, before which the first ran.
    double start(const TimeTaken& taken);
    /// Add one that takes so long, and as many bytes while it runs.
    void add(double seconds, double bytes);
    /// "expected in all: ...", or "" for one.
    VMLIGHT_API std::string text() const;

private:
    bool m_started = false;
    int64_t m_count = 0;
    double m_seconds = 0, m_bytes = 0;
};

/// Bytes that are held now, and `more`; or what was held before, if that is more: to read and build a large scene takes
/// more than to have it.
double expected_bytes(double more);

} // namespace vmlight
