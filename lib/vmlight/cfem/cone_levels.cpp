// SPDX-License-Identifier: Apache-2.0
#include <vmlight/cfem/cone_levels.h>

#include <vmlight/base/parallel.h>
#include <vmlight/cfem/rows.h>
#include <vmlight/cfem/spherical_harmonics.h>
#include <vmlight/math/latlong.h>

#include <algorithm>
#include <array>
#include <cmath>

namespace vmlight {
namespace {

constexpr int kBands = 128;
constexpr int kSteps = 4096; // of the integral over the kernel

// What the kernel of a cone multiplies bands with: 2 pi Int k P_l dx, over the same for l = 0.
std::array<double, kBands> eigenvalues(double angle, double exponent)
{
    std::array<double, kBands> sums {};
    for (int i = 0; i < kSteps; ++i) {
        const double theta = latlong::pi * (i + 0.5) / kSteps, x = std::cos(theta);
        const double weight = std::pow(std::max(0.0, std::cos(theta - angle)), exponent) * std::sin(theta);
        double before = 0, legendre = 1; // P_-1, P_0
        for (int l = 0; l < kBands; ++l) {
            sums[size_t(l)] += weight * legendre;
            const double next = ((2 * l + 1) * x * legendre - l * before) / (l + 1);
            before = legendre;
            legendre = next;
        }
    }
    const double all = sums[0];
    for (double& sum : sums)
        sum /= all;
    return sums;
}

// Of a lobe, in radians.
double lobe_width(double exponent)
{
    return 1 / std::sqrt(exponent);
}

} // namespace

bool ConeLevels::make(const Environment& environment, double exponent, int nthreads, std::string& error)
{
    EnvironmentRows rows(environment, false);
    std::vector<double> projected;
    if (!rows.open()
        || !project_harmonics(projected, kBands, rows.grid(), [&](int row, float* rgb) { return rows.read(row, rgb); },
                              nthreads, {})) {
        error = rows.error();
        return false;
    }
    // Half a lobe's width apart, so that linear in between is near: within 1.5 % of the brightest.
    const double step = std::min(0.05, lobe_width(exponent) / 2);
    count = 1 + int(std::ceil(latlong::pi / 2 / step));
    height = int(std::ceil(latlong::pi / step));
    width = 2 * height;
    const size_t floats = 3 * size_t(width) * size_t(height);
    texels.resize(floats * size_t(count));
    parallel_items(count, nthreads, [&](int64_t level, int) {
        const auto factors = eigenvalues(latlong::pi / 2 * double(level) / (count - 1), exponent);
        std::vector<double> filtered = projected, rgb;
        size_t at = 0;
        for (int l = 0; l < kBands; ++l)
            for (int i = 0; i < 3 * (2 * l + 1); ++i)
                filtered[at++] *= factors[size_t(l)];
        evaluate_harmonics(rgb, { width, height }, filtered, kBands, 1);
        for (size_t i = 0; i < floats; ++i) // where bands that are left out ring
            texels[floats * size_t(level) + i] = float(std::max(0.0, rgb[i]));
    });
    return true;
}

void ConeLevels::look(float* rgb, Imath::V3d tangent, double cos_angle) const
{
    if (cos_angle < 0) {
        tangent = -tangent;
        cos_angle = -cos_angle;
    }
    const Imath::V2d st = latlong::position(tangent);
    const double u = st.x * width - 0.5, v = std::clamp(st.y * height - 0.5, 0.0, double(height - 1));
    const double z = std::acos(std::min(1.0, cos_angle)) / (latlong::pi / 2) * (count - 1);
    const int column = int(std::floor(u)), row = std::min(int(v), height - 2), level = std::min(int(z), count - 2);
    std::fill_n(rgb, 3, 0.0f);
    for (int k = 0; k < 8; ++k) {
        const int dx = k & 1, dy = k >> 1 & 1, dz = k >> 2;
        const double weight
            = std::abs(1 - dx - (u - column)) * std::abs(1 - dy - (v - row)) * std::abs(1 - dz - (z - level));
        const int x = (column + dx + width) % width;
        const float* texel
            = &texels[3 * ((size_t(level + dz) * size_t(height) + size_t(row + dy)) * size_t(width) + size_t(x))];
        for (int c = 0; c < 3; ++c)
            rgb[c] += float(weight) * texel[c];
    }
}

} // namespace vmlight
