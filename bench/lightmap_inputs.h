// SPDX-License-Identifier: Apache-2.0
/// What the benchmarks of lightmaps light and with what, and how they take times.
#pragma once

#include <vmlight/image/channels.h>
#include <vmlight/math/latlong.h>

#include <OpenImageIO/imagebuf.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstddef>
#include <random>
#include <vector>

namespace vmlight {

constexpr int kSide = 1024;
constexpr size_t kTexels = size_t(kSide) * kSide;

enum Content
{
    smooth,
    random_directions
};

inline OIIO::ImageBuf visibility_map(Content content)
{
    OIIO::ImageSpec spec(kSide, kSide, 4, OIIO::TypeFloat);
    spec.channelnames.assign(kVismapChannels.begin(), kVismapChannels.end());
    OIIO::ImageBuf image(spec);
    std::mt19937 random(1);
    std::uniform_real_distribution<float> unit(0, 1);
    float* texel = static_cast<float*>(image.localpixels());
    for (int y = 0; y < kSide; ++y)
        for (int x = 0; x < kSide; ++x, texel += 4) {
            const float s = content == smooth ? (x + 0.5f) / kSide : unit(random);
            const float t = content == smooth ? (y + 0.5f) / kSide : std::acos(1 - 2 * unit(random)) / 3.1415927f;
            const float v = content == smooth ? 0.5f + 0.4f * std::sin(20 * s) * std::sin(20 * t) : unit(random);
            const Imath::V3f b = latlong::direction(s, t) * (v * (1 - v / 3));
            texel[0] = v, texel[1] = b.x, texel[2] = b.y, texel[3] = b.z;
        }
    return image;
}

inline OIIO::ImageBuf environment()
{
    OIIO::ImageBuf image(OIIO::ImageSpec(256, 128, 3, OIIO::TypeFloat));
    float* pixel = static_cast<float*>(image.localpixels());
    for (int y = 0; y < 128; ++y)
        for (int x = 0; x < 256; ++x, pixel += 3) {
            const Imath::V3f d = latlong::direction((x + 0.5f) / 256, (y + 0.5f) / 128);
            pixel[0] = 1 + 0.5f * d.x, pixel[1] = 1 + 0.5f * d.y, pixel[2] = 1 + 0.5f * d.z * d.x;
        }
    return image;
}

template <class Work> double seconds(Work&& work)
{
    const auto start = std::chrono::steady_clock::now();
    work();
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

/// Other work on the machine only ever adds time.
inline double best(const std::vector<double>& times)
{
    return *std::min_element(times.begin(), times.end());
}

} // namespace vmlight
