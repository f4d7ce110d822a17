// SPDX-License-Identifier: Apache-2.0
/// A visibility map in memory, for tests that look at its texels.
#pragma once

#include <vmlight/vismap/baker.h>
#include <vmlight/vismap/vismap.h>

#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <vector>

namespace vmlight {

struct Texel
{
    float visibility;
    Imath::V3f direction;

    bool operator==(const Texel& other) const { return visibility == other.visibility && direction == other.direction; }
    bool is_zero() const { return visibility == 0 && direction == Imath::V3f(0); }
};

class BakedMap
{
public:
    BakedMap(const Mesh& mesh, const std::vector<Mesh>& occluders, const VismapParams& params, int nthreads = 0)
    {
        EXPECT_TRUE(make_vismap(m_image, mesh, occluders, params, &report, nthreads)) << m_image.geterror();
    }
    /// Of a scene that several maps share: to build one may take longer than its rays.
    BakedMap(const BakeScenePointer& scene, const VismapParams& params)
    {
        EXPECT_TRUE(make_vismap(m_image, scene, params, &report, 0, {})) << m_image.geterror();
    }
    Texel at(int x, int y) const
    {
        float p[4];
        m_image.getpixel(x, y, 0, p, 4);
        return { p[0], Imath::V3f(p[1], p[2], p[3]) };
    }
    const OIIO::ImageBuf& image() const { return m_image; }
    const OIIO::ImageSpec& spec() const { return m_image.spec(); }
    template <class Visit> void each(Visit&& visit) const
    {
        for (int y = 0; y < spec().height; ++y)
            for (int x = 0; x < spec().width; ++x)
                visit(at(x, y), x, y);
    }
    /// Texels that a triangle covers; the map must have the channel `coverage`.
    template <class Visit> void each_covered(Visit&& visit) const
    {
        float p[5];
        for (int y = 0; y < spec().height; ++y)
            for (int x = 0; x < spec().width; ++x) {
                m_image.getpixel(x, y, 0, p, 5);
                if (p[4] == 1)
                    visit(Texel { p[0], Imath::V3f(p[1], p[2], p[3]) }, x, y);
            }
    }
    bool operator==(const BakedMap& other) const
    {
        bool equal = spec().width == other.spec().width && spec().height == other.spec().height;
        if (equal)
            each([&](const Texel& t, int x, int y) { equal &= t == other.at(x, y); });
        return equal;
    }

    VismapReport report;

private:
    OIIO::ImageBuf m_image;
};

inline VismapParams map_params(int width, int height, int samples, const std::string& sampler = "fibonacci")
{
    VismapParams params;
    params.resolution = { width, height };
    params.samples = samples;
    params.sampler = sampler;
    params.margin = 0;
    params.channels = { "coverage" };
    params.skip_open = false; // what is tested is the rays
    params.reconstruct = "off";
    return params;
}

/// Visibility and direction of a point, known from a closed form.
struct Truth
{
    double visibility;
    Imath::V3d direction;
    double uniform_visibility = -1; ///< for `measure = "uniform"`; less than 0 if there is no closed form
};

/// Root mean square error over a map all of whose texels see the same.
struct MapError
{
    double visibility = 0, direction = 0; ///< direction: length of the error of B
    double visibility_bias = 0, direction_bias = 0;
    double angle = 0; ///< degrees between B and the true one
};

inline MapError error_of(const BakedMap& map, const Truth& truth)
{
    double v2 = 0, d2 = 0, v = 0, a2 = 0;
    Imath::V3d d(0);
    double texels = 0;
    map.each([&](const Texel& t, int, int) {
        const double dv = t.visibility - truth.visibility;
        const Imath::V3d b(t.direction), dd = b - truth.direction;
        const double angle = std::atan2(b.cross(truth.direction).length(), b.dot(truth.direction)) * 180 / M_PI;
        v += dv, v2 += dv * dv, d += dd, d2 += dd.length2(), a2 += angle * angle;
        ++texels;
    });
    MapError error;
    error.visibility = std::sqrt(v2 / texels);
    error.direction = std::sqrt(d2 / texels);
    error.visibility_bias = v / texels;
    error.direction_bias = d.length() / texels;
    error.angle = std::sqrt(a2 / texels);
    return error;
}

/// Texels of `covered` that are not equal to `wanted`.
template <class Wanted> int64_t count_covered_unless(const BakedMap& map, Wanted&& wanted)
{
    int64_t count = 0;
    map.each_covered([&](const Texel& t, int, int) { count += !wanted(t); });
    return count;
}

} // namespace vmlight
