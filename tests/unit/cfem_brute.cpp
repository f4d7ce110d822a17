// SPDX-License-Identifier: Apache-2.0
#include "cfem_brute.h"

#include <algorithm>
#include <cmath>

namespace brute {

V3d center(int x, int y, int width, int height)
{
    return vmlight::latlong::direction((x + 0.5) / width, (y + 0.5) / height);
}

V3d moment(int x, int y, int width, int height)
{
    const double t0 = pi * y / height, t1 = pi * (y + 1) / height;
    const double p0 = 2 * pi * (double(x) / width - 0.5), p1 = 2 * pi * (double(x + 1) / width - 0.5);
    // 2 Int sin^2 = (t1 - t0) - sin(t1 - t0) cos(t1 + t0), 2 Int sin cos = sin(t1 - t0) sin(t1 + t0)
    const double across = 0.5 * ((t1 - t0) - std::sin(t1 - t0) * std::cos(t1 + t0));
    const double up = 0.5 * std::sin(t1 - t0) * std::sin(t1 + t0);
    return { across * (std::cos(p1) - std::cos(p0)), up * (p1 - p0), across * (std::sin(p1) - std::sin(p0)) };
}

double solid_angle(int y, int width, int height)
{
    return vmlight::latlong::row_solid_angle(y, height) / width;
}

double pixel_radius(int y, int width, int height)
{
    const double theta = pi * (y + 0.5) / height, reach = pi / (2 * height);
    const bool equator = theta - reach < pi / 2 && theta + reach > pi / 2;
    const double widest = equator ? 1 : std::max(std::sin(theta - reach), std::sin(theta + reach));
    return reach + std::min(pi, pi / width * std::max(0.0, widest));
}

namespace {

// (1/pi) Int max(0, n.w) dw over a pixel that the horizon of n may cut, by `parts` x `parts` points.
double cut_response(const V3d& n, int x, int y, int width, int height, int parts)
{
    double sum = 0, weight = 0;
    for (int j = 0; j < parts; ++j) {
        const double t = (y + (j + 0.5) / parts) / height, w = std::sin(pi * t);
        for (int i = 0; i < parts; ++i) {
            const V3d d = vmlight::latlong::direction((x + (i + 0.5) / parts) / width, t);
            sum += w * std::max(0.0, n.dot(d));
            weight += w;
        }
    }
    return sum / weight * solid_angle(y, width, height) / pi;
}

} // namespace

double pixel_response(const V3d& n, int x, int y, int width, int height, int parts)
{
    const double up = n.dot(center(x, y, width, height)), radius = pixel_radius(y, width, height);
    if (radius < pi / 2 && up > std::sin(radius))
        return n.dot(moment(x, y, width, height)) / pi;
    if (radius < pi / 2 && up < -std::sin(radius))
        return 0;
    return cut_response(n, x, y, width, height, parts);
}

Filter::Filter(const Map& map, int parts)
    : m_map(map)
    , m_parts(parts)
{
    for (int y = 0; y < map.height; ++y) {
        const double radius = pixel_radius(y, map.width, map.height);
        m_sine.push_back(radius < pi / 2 ? std::sin(radius) : 2);
        for (int x = 0; x < map.width; ++x) {
            m_center.push_back(center(x, y, map.width, map.height));
            m_moment.push_back(moment(x, y, map.width, map.height));
        }
    }
}

V3d Filter::operator()(const V3d& n) const
{
    V3d sum(0);
    size_t i = 0;
    for (int y = 0; y < m_map.height; ++y)
        for (int x = 0; x < m_map.width; ++x, ++i) {
            const double up = n.dot(m_center[i]);
            if (up < -m_sine[size_t(y)])
                continue;
            const double response = up > m_sine[size_t(y)] ? n.dot(m_moment[i]) / pi
                                                           : cut_response(n, x, y, m_map.width, m_map.height, m_parts);
            sum += V3d(m_map.rgb[3 * i], m_map.rgb[3 * i + 1], m_map.rgb[3 * i + 2]) * response;
        }
    return sum;
}

V3d lobe_filtered(const Map& map, const V3d& d, double s, int parts)
{
    V3d sum(0);
    for (int y = 0; y < map.height; ++y)
        for (int x = 0; x < map.width; ++x) {
            const float* light = map.at(x, y);
            if (light[0] + light[1] + light[2] == 0)
                continue;
            double kernel = 0, all = 0;
            for (int j = 0; j < parts; ++j)
                for (int i = 0; i < parts; ++i) {
                    const double t = (y + (j + 0.5) / parts) / map.height, weight = std::sin(pi * t);
                    const double up = d.dot(vmlight::latlong::direction((x + (i + 0.5) / parts) / map.width, t));
                    kernel += up <= 0 ? 0 : weight * (s + 1) / (2 * pi) * std::pow(up, s);
                    all += weight;
                }
            sum += V3d(light[0], light[1], light[2]) * (kernel / all * solid_angle(y, map.width, map.height));
        }
    return sum;
}

V3d mean(const Map& map)
{
    V3d sum(0);
    for (int y = 0; y < map.height; ++y)
        for (int x = 0; x < map.width; ++x)
            sum += V3d(map.at(x, y)[0], map.at(x, y)[1], map.at(x, y)[2]) * solid_angle(y, map.width, map.height);
    return sum / (4 * pi);
}

} // namespace brute
