// SPDX-License-Identifier: Apache-2.0
/// Maps of light to filter, and measures of what comes out: for the tests of the cfem rooms.
#pragma once

#include "cfem_brute.h"

#include <vmlight/cfem/cfem.h>

#include <OpenImageIO/imagebuf.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

namespace cfem_maps {

using namespace vmlight;
using brute::center;
using brute::Map;
using brute::pi;
using brute::V3d;

inline OIIO::ImageBuf image(const Map& map)
{
    OIIO::ImageBuf buf(OIIO::ImageSpec(map.width, map.height, 3, OIIO::TypeFloat));
    buf.set_pixels(buf.roi(), OIIO::TypeFloat, map.rgb.data());
    return buf;
}

inline CfemParams exact(int width, int height)
{
    CfemParams params;
    params.resolution = { width, height };
    return params;
}

inline CfemParams harmonics(int order, int width, int height)
{
    CfemParams params = exact(width, height);
    params.filter = "sh";
    params.order = order;
    return params;
}

inline Map filtered(const OIIO::ImageBuf& env, const CfemParams& params, int nthreads = 1)
{
    OIIO::ImageBuf dst;
    Map map(params.resolution.width, params.resolution.height);
    EXPECT_TRUE(make_cfem(dst, env, params, nthreads)) << dst.geterror();
    EXPECT_TRUE(dst.get_pixels(dst.roi(), OIIO::TypeFloat, map.rgb.data()));
    return map;
}

inline Map filtered(const Map& map, int width, int height)
{
    return filtered(image(map), exact(width, height));
}

// A map of one colour is not filtered. Here its blue is another in the last bit of one pixel, so that it is; red and
// green are still of one value.
inline Map almost(Map map)
{
    float& last = map.rgb.back();
    last = std::nextafter(last, last > 1 ? 0.0f : 2.0f);
    return map;
}

// What becomes of red and green of almost() this map; green also in place of blue.
inline Map filtered_anyway(const Map& map, int width, int height)
{
    Map result = filtered(almost(map), width, height);
    for (size_t i = 0; i < result.rgb.size(); i += 3)
        result.rgb[i + 2] = result.rgb[i + 1];
    return result;
}

inline std::string refusal(const OIIO::ImageBuf& env, const CfemParams& params = exact(4, 2))
{
    OIIO::ImageBuf dst(OIIO::ImageSpec(2, 2, 3, OIIO::TypeFloat));
    EXPECT_FALSE(make_cfem(dst, env, params, 1));
    EXPECT_EQ(dst.spec().width, 0) << "a failed filter left pixels";
    return dst.geterror();
}

// Light given by a function of direction, sampled at pixel centres.
template <class Light> inline Map sampled(int width, int height, Light&& light)
{
    Map map(width, height);
    for (int y = 0; y < height; ++y)
        for (int x = 0; x < width; ++x) {
            const V3d value = light(center(x, y, width, height));
            for (int k = 0; k < 3; ++k)
                map.at(x, y)[k] = float(value[k]);
        }
    return map;
}

inline Map random_map(int width, int height, unsigned seed)
{
    std::mt19937 random(seed);
    Map map(width, height);
    for (float& value : map.rgb)
        value = float(random() % 1000) / 1000;
    return map;
}

// Largest |cfem - want(n)| over all pixels and channels.
template <class Want> inline double largest_error(const Map& cfem, Want&& want)
{
    double worst = 0;
    for (int y = 0; y < cfem.height; ++y)
        for (int x = 0; x < cfem.width; ++x) {
            const V3d expected = want(center(x, y, cfem.width, cfem.height));
            for (int k = 0; k < 3; ++k)
                worst = std::max(worst, std::abs(cfem.at(x, y)[k] - expected[k]));
        }
    return worst;
}

inline double largest_difference(const Map& a, const Map& b)
{
    double worst = 0;
    for (size_t i = 0; i < a.rgb.size(); ++i)
        worst = std::max(worst, double(std::abs(a.rgb[i] - b.rgb[i])));
    return worst;
}

/// What a surface that faces `normal` sees of one hot texel over light of 1: as the filter has it, and in truth.
struct HotTexelLight
{
    const Map& map;
    V3d normal;
    double filtered, truth, mean; ///< mean of the map
};

/// Filter 64x32 texels of 1, of which one is 1e6, to 32x16, and visit each of these.
template <class Visit> inline void each_light_of_hot_texel(int column, int row, Visit&& visit)
{
    Map map(64, 32, 1);
    std::fill_n(map.at(column, row), 3, 1e6f);
    const double mean = brute::mean(map)[0];
    const Map cfem = filtered(map, 32, 16);
    for (int y = 0; y < 16; ++y)
        for (int x = 0; x < 32; ++x) {
            const V3d n = center(x, y, 32, 16);
            const double truth = 1 + (1e6 - 1) * brute::pixel_response(n, column, row, 64, 32, 256);
            visit(HotTexelLight { map, n, cfem.at(x, y)[0], truth, mean });
        }
}

// A smooth light that no symmetry of the grid leaves alone.
inline V3d soft_light(const V3d& w)
{
    const V3d lobe = V3d(1, 2, -0.5).normalized();
    return { std::exp(2 * w.dot(lobe)), 1 + 0.8 * w.x * w.y, std::exp(-w.z) };
}

} // namespace cfem_maps
