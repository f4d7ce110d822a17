// SPDX-License-Identifier: Apache-2.0
/// What fuzzers hold results to.
#pragma once

#include <OpenImageIO/imagebufalgo.h>

#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <string>
#include <vector>

namespace vmlight::fuzz {

/// Ends the process, for the fuzzer to keep the bytes, unless `good`.
inline void require(bool good, const char* law, const std::string& seen)
{
    if (good)
        return;
    std::fprintf(stderr, "%s: %s\n", law, seen.c_str());
    std::abort();
}

inline void require_reason(const std::string& error)
{
    require(!error.empty(), "a refusal has a reason", error);
    require(error.find_first_of(std::string("\n\r\0", 3)) == std::string::npos, "a reason is one line", error);
}

/// All of an image's numbers, channel by channel within the pixel.
inline std::vector<float> pixels_of(const OIIO::ImageBuf& image)
{
    std::vector<float> pixels(size_t(image.spec().image_pixels()) * image.nchannels());
    require(image.get_pixels(image.roi(), OIIO::TypeFloat, pixels.data()), "an image has pixels", image.geterror());
    return pixels;
}

/// For what make_x() returned of `dst`: either a reason and no pixels, or finite pixels.
inline void require_made(bool made, const OIIO::ImageBuf& dst)
{
    if (!made) {
        require(!dst.initialized(), "a refusal leaves no half image",
                dst.spec().serialize(OIIO::ImageSpec::SerialText));
        return require_reason(dst.geterror());
    }
    for (float value : pixels_of(dst))
        require(std::isfinite(value), "pixels are finite", dst.spec().serialize(OIIO::ImageSpec::SerialText));
}

} // namespace vmlight::fuzz
