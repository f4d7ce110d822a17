// SPDX-License-Identifier: Apache-2.0
/// What every stage takes besides its own work, for --dry-run.
#pragma once

#include <OpenImageIO/imageio.h>

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

/// Bytes that are held now, and as many floats of an image as `images` of it.
double expected_bytes(const OIIO::ImageSpec& spec, double images);

} // namespace vmlight
