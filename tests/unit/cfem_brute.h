// SPDX-License-Identifier: Apache-2.0
/// Cosine filtering the slow way, in double, pixel by pixel: the reference of the tests and the benchmark. Shares
/// nothing with the filter but the frame of latlong.h.
#pragma once

#include <vmlight/math/latlong.h>

#include <Imath/ImathVec.h>

#include <vector>

namespace brute {

using Imath::V3d;
using vmlight::latlong::pi;

struct Map
{
    int width, height;
    std::vector<float> rgb;

    Map(int w, int h, float value = 0)
        : width(w)
        , height(h)
        , rgb(size_t(3) * w * h, value)
    {
    }
    float* at(int x, int y) { return &rgb[3 * (size_t(y) * width + x)]; }
    const float* at(int x, int y) const { return &rgb[3 * (size_t(y) * width + x)]; }
};

/// The direction of a pixel's centre.
V3d center(int x, int y, int width, int height);
/// Int w dw over a pixel, in closed form.
V3d moment(int x, int y, int width, int height);
/// Of a pixel of row y.
double solid_angle(int y, int width, int height);
/// No point of a pixel is farther from its centre than this angle.
double pixel_radius(int y, int width, int height);
/// (1/pi) Int max(0, n.w) dw over a pixel: in closed form if it is wholly in front of n or behind it, else by `parts` x
/// `parts` points.
double pixel_response(const V3d& n, int x, int y, int width, int height, int parts);

/// C(n) of a map, for many n.
class Filter
{
public:
    /// `map` must outlive this.
    Filter(const Map& map, int parts);
    V3d operator()(const V3d& n) const;

private:
    const Map& m_map;
    int m_parts;
    std::vector<V3d> m_center, m_moment;
    std::vector<double> m_sine; // of the pixels' radius, by row
};

/// Int L K dw, where K is the lobe of power s around d, by parts x parts points within each pixel that holds light.
V3d lobe_filtered(const Map& map, const V3d& d, double s, int parts);

/// Mean over the sphere.
V3d mean(const Map& map);

} // namespace brute
