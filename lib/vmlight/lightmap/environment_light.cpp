// SPDX-License-Identifier: Apache-2.0
#include <vmlight/lightmap/environment_light.h>

#include <vmlight/cfem/rows.h>
#include <vmlight/math/latlong.h>

#include <algorithm>
#include <cmath>

namespace vmlight {

using Imath::V3d;
using Imath::V3f;
using latlong::pi;

namespace {

double cell_height(const EnvironmentGrid& grid, int row) // in cos theta
{
    // As a product: exact near the poles, where the difference of cosines cancels.
    const double a = grid.row_edge(row), b = grid.row_edge(row + 1);
    return 2 * std::sin(0.5 * (a + b)) * std::sin(0.5 * (b - a));
}

double cell_width(const EnvironmentGrid& grid, int column)
{
    return grid.column_edge(column + 1) - grid.column_edge(column);
}

// The first entry above `x`, and the position of `x` between the entry before and this one.
template <class Sums> int find_share(const Sums* sums, int count, double x, double& within)
{
    const int found = int(std::upper_bound(sums, sums + count, x) - sums);
    // Beyond the end by rounding: the last entry with a share.
    const int last = int(std::lower_bound(sums, sums + count, sums[count - 1]) - sums);
    const int index = std::min(found, last);
    const double low = index ? double(sums[index - 1]) : 0, high = double(sums[index]);
    within = high > low ? std::clamp((x - low) / (high - low), 0.0, 1.0) : 0.5;
    return index;
}

} // namespace

bool EnvironmentLight::build(const OIIO::ImageBuf& env, bool sanitize, std::string& error)
{
    EnvironmentRows rows(env, sanitize);
    if (!rows.open()) {
        error = rows.error();
        return false;
    }
    m_grid = rows.grid();
    const size_t width = size_t(m_grid.width), height = size_t(m_grid.height);
    m_rgb.resize(3 * width * height);
    m_columns.resize(width * height);
    m_rows.resize(height);
    double total = 0;
    std::vector<double> sums(width);
    for (size_t j = 0; j < height; ++j) {
        float* rgb = &m_rgb[3 * j * width];
        if (!rows.read(int(j), rgb)) {
            error = rows.error();
            return false;
        }
        double sum = 0;
        for (size_t i = 0; i < width; ++i) {
            const double mean = (double(rgb[3 * i]) + rgb[3 * i + 1] + rgb[3 * i + 2]) / 3;
            sums[i] = sum += mean * cell_width(m_grid, int(i));
        }
        for (size_t i = 0; i < width; ++i)
            m_columns[j * width + i] = sum > 0 ? float(sums[i] / sum) : 0;
        m_rows[j] = total += sum * cell_height(m_grid, int(j));
    }
    for (double& row : m_rows)
        row = total > 0 ? row / total : 0;
    return true;
}

EnvironmentSample EnvironmentLight::sample(double u, double v) const
{
    double across = 0, down = 0;
    const int row = find_share(m_rows.data(), m_grid.height, v, down);
    const int column = find_share(&m_columns[size_t(row) * m_grid.width], m_grid.width, u, across);
    const double phi = m_grid.column_edge(column) + across * cell_width(m_grid, column);
    // Uniform in cos theta, from the upper edge: cos theta = cos a - x, so that sin^2(theta / 2) = sin^2(a / 2) + x
    // / 2.
    const double half_sine = std::sin(0.5 * m_grid.row_edge(row));
    const double square = std::min(1.0, half_sine * half_sine + 0.5 * down * cell_height(m_grid, row));
    const double cosine = 1 - 2 * square, sine = 2 * std::sqrt(square * (1 - square));
    const double turn = phi - pi; // latlong.h's phi
    return in_cell(column, row, V3d(-std::sin(turn) * sine, cosine, std::cos(turn) * sine));
}

EnvironmentSample EnvironmentLight::at(const V3d& direction) const
{
    const auto st = latlong::position(direction);
    const double down = m_grid.border ? st.y * (m_grid.height - 1) + 0.5 : st.y * m_grid.height;
    const double across = m_grid.column_scale() * 2 * pi * st.x + m_grid.column_offset();
    return in_cell(std::clamp(int(across), 0, m_grid.width - 1), std::clamp(int(down), 0, m_grid.height - 1),
                   direction);
}

EnvironmentSample EnvironmentLight::in_cell(int column, int row, const V3d& direction) const
{
    const size_t pixel = size_t(row) * m_grid.width + column;
    EnvironmentSample sample;
    sample.direction = direction;
    sample.radiance = V3f(m_rgb[3 * pixel], m_rgb[3 * pixel + 1], m_rgb[3 * pixel + 2]);
    const double share = (m_rows[row] - (row ? m_rows[row - 1] : 0))
        * (double(m_columns[pixel]) - (column ? double(m_columns[pixel - 1]) : 0));
    sample.density = share / (cell_width(m_grid, column) * cell_height(m_grid, row));
    return sample;
}

} // namespace vmlight
