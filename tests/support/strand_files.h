// SPDX-License-Identifier: Apache-2.0
/// Strands and their files, for tests.
#pragma once

#include <vmlight/mesh/strands.h>

#include <cmath>
#include <cstdint>
#include <cstring>
#include <initializer_list>
#include <string>
#include <vector>

namespace vmlight::strand_files {

using Imath::V3d;

/// Straight strands of `points` evenly spaced points, each from its first to its second end.
inline Strands straight(const std::vector<std::pair<V3d, V3d>>& ends, double radius, int points = 4)
{
    Strands strands;
    strands.name = strands.path = "straight";
    for (const auto& [root, tip] : ends) {
        for (int i = 0; i < points; ++i) {
            strands.points.push_back(root + (tip - root) * (double(i) / (points - 1)));
            strands.radii.push_back(radius);
        }
        strands.ends.push_back(uint32_t(strands.points.size()));
    }
    return strands;
}

/// Curls around the y axis, from a ball of radius .5 outwards.
inline Strands curls(int count, double radius, int points = 12)
{
    Strands strands;
    strands.name = strands.path = "curls";
    for (int i = 0; i < count; ++i) {
        const double y = 1 - 2 * (i + 0.5) / count, turn = 2.39996 * i, across = std::sqrt(1 - y * y);
        const V3d out(across * std::cos(turn), y, across * std::sin(turn)), side(-out.z, 0, out.x);
        for (int k = 0; k < points; ++k) {
            const double share = double(k) / (points - 1);
            strands.points.push_back(out * (0.5 + 0.4 * share) + side * (0.06 * std::sin(9 * share + i))
                                     + V3d(0, 0.06 * (std::cos(9 * share + i) - 2 * share * share), 0));
            strands.radii.push_back(radius);
        }
        strands.ends.push_back(uint32_t(strands.points.size()));
    }
    return strands;
}

template <class Number> std::string raw(std::initializer_list<Number> numbers)
{
    std::string bytes;
    for (const Number number : numbers)
        bytes.append(reinterpret_cast<const char*>(&number), sizeof(number));
    return bytes;
}

/// TressFX 4: `strands` strands of `points` points (s, p, 0).
inline std::string tfx(uint32_t strands, uint32_t points, float version = 4, uint32_t offset = 160)
{
    std::string bytes = raw<float>({ version }) + raw<uint32_t>({ strands, points, offset });
    bytes.resize(160, '\0');
    for (uint32_t s = 0; s < strands; ++s)
        for (uint32_t p = 0; p < points; ++p)
            bytes += raw<float>({ float(s), float(p), 0, 1 });
    return bytes;
}

/// TressFX 4 of strands that have as many points each.
inline std::string tfx_of(const Strands& strands)
{
    std::string bytes = tfx(0, 0);
    const auto count = uint32_t(strands.count());
    const std::string header = raw<uint32_t>({ count, uint32_t(strands.points.size() / count) });
    bytes.replace(sizeof(float), header.size(), header);
    for (const V3d& p : strands.points)
        bytes += raw<float>({ float(p.x), float(p.y), float(p.z), 1 });
    return bytes;
}

/// HAIR: strands of 1 and 2 segments along y, with the thickness of each point if `has_thickness`.
inline std::string hair(bool has_thickness, uint32_t points = 5, float thickness_of_all = 0)
{
    std::string bytes = "HAIR" + raw<uint32_t>({ 2, points, has_thickness ? 7u : 3u, 0 })
        + raw<float>({ thickness_of_all, 0, 1, 1, 1 });
    bytes.resize(128, ' ');
    bytes += raw<uint16_t>({ 1, 2 });
    for (const float y : { 0.f, 1.f, 0.f, 1.f, 2.f })
        bytes += raw<float>({ 3, y, 0 });
    if (has_thickness)
        bytes += raw<float>({ .2f, .1f, .4f, .2f, .1f });
    return bytes;
}

} // namespace vmlight::strand_files
