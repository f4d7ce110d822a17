// SPDX-License-Identifier: Apache-2.0
/// Small visibility maps and environments for the tests of shading.
#pragma once

#include <vmlight/image/channels.h>
#include <vmlight/lightmap/lightmap.h>
#include <vmlight/math/latlong.h>

#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <functional>
#include <random>

namespace scene {

using Imath::V3d;
using Imath::V3f;
using OIIO::ImageBuf;
using OIIO::ImageSpec;

struct VismapTexel
{
    float v;
    V3f b;
};

inline float* pixels(ImageBuf& image)
{
    return static_cast<float*>(image.localpixels());
}
inline const float* pixels(const ImageBuf& image)
{
    return static_cast<const float*>(image.localpixels());
}

inline ImageBuf vismap(int width, int height, const std::function<VismapTexel(int x, int y)>& at)
{
    ImageSpec spec(width, height, 4, OIIO::TypeFloat);
    spec.channelnames.assign(vmlight::kVismapChannels.begin(), vmlight::kVismapChannels.end());
    ImageBuf image(spec);
    for (int y = 0; y < height; ++y)
        for (int x = 0; x < width; ++x) {
            const VismapTexel texel = at(x, y);
            const float values[4] { texel.v, texel.b.x, texel.b.y, texel.b.z };
            image.setpixel(x, y, values, 4);
        }
    return image;
}

/// Texels that see from nothing to all, as they look anywhere.
inline ImageBuf random_vismap(int width, int height)
{
    std::mt19937 random(3);
    std::normal_distribution<float> normal;
    std::uniform_real_distribution<float> unit;
    return vismap(width, height, [&](int, int) {
        const float v = unit(random);
        const V3f w(normal(random), normal(random), normal(random));
        return VismapTexel { v, w.normalized() * (v * (1 - v / 3)) };
    });
}

inline ImageBuf one_texel(float v, V3f b)
{
    return vismap(1, 1, [&](int, int) { return VismapTexel { v, b }; });
}

inline ImageBuf cfem(int width, int height, const std::function<V3f(V3d direction)>& at)
{
    ImageBuf image(ImageSpec(width, height, 3, OIIO::TypeFloat));
    for (int y = 0; y < height; ++y)
        for (int x = 0; x < width; ++x) {
            const V3f c = at(vmlight::latlong::direction((x + 0.5) / width, (y + 0.5) / height));
            image.setpixel(x, y, &c.x, 3);
        }
    return image;
}

/// A different colour in every texel, so that no shift or swap goes unseen.
inline ImageBuf random_cfem(int width, int height)
{
    std::mt19937 random(5);
    std::uniform_real_distribution<float> unit;
    return cfem(width, height, [&](V3d) { return V3f(unit(random), unit(random), unit(random)); });
}

/// Light of one colour is not looked up. With another last bit of the last pixel's blue it is.
inline ImageBuf almost(ImageBuf light)
{
    float& last = pixels(light)[light.spec().image_pixels() * 3 - 1];
    last = std::nextafter(last, 0.0f);
    return light;
}

inline V3f color(const ImageBuf& image, int x = 0, int y = 0)
{
    V3f c(0);
    image.getpixel(x, y, &c.x, 3);
    return c;
}

inline ImageBuf lit(const ImageBuf& vismap, const ImageBuf& cfem, const vmlight::LightmapParams& params = {},
                    const ImageBuf* albedo = nullptr, int nthreads = 1)
{
    ImageBuf dst;
    EXPECT_TRUE(vmlight::make_lightmap(dst, vismap, cfem, params, albedo, nthreads)) << dst.geterror();
    return dst;
}

/// Largest difference of a channel between two images of R, G, B and one size.
inline float difference(const ImageBuf& a, const ImageBuf& b)
{
    float worst = a.roi() == b.roi() && a.nchannels() == 3 && b.nchannels() == 3 ? 0 : INFINITY;
    for (int y = a.ybegin(); y < a.yend(); ++y)
        for (int x = a.xbegin(); x < a.xend(); ++x)
            for (int c = 0; c < 3; ++c)
                worst = std::max(worst, std::abs(color(a, x, y)[c] - color(b, x, y)[c]));
    return worst;
}

inline bool same_bits(const ImageBuf& a, const ImageBuf& b)
{
    return a.roi() == b.roi() && a.nchannels() == 3 && b.nchannels() == 3
        && std::memcmp(a.localpixels(), b.localpixels(), 12 * a.spec().image_pixels()) == 0;
}

} // namespace scene
