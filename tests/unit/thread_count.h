// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <OpenImageIO/imageio.h>

namespace vmlight {

/// The number of threads that parallel work uses by default, until the end of the scope.
struct ThreadCount
{
    explicit ThreadCount(int count) { OIIO::attribute("threads", count); }
    ~ThreadCount() { OIIO::attribute("threads", before); }
    ThreadCount(const ThreadCount&) = delete;
    ThreadCount& operator=(const ThreadCount&) = delete;
    const int before = OIIO::get_int_attribute("threads");
};

} // namespace vmlight
