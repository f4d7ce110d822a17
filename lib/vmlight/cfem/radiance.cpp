// SPDX-License-Identifier: Apache-2.0
#include <vmlight/cfem/radiance.h>

#include <vmlight/base/work_counts.h>
#include <vmlight/cfem/one_color.h>
#include <vmlight/cfem/rows.h>
#include <vmlight/cfem/stack.h>
#include <vmlight/math/latlong.h>

#include <algorithm>
#include <cmath>
#include <vector>

namespace vmlight {

using latlong::pi;

namespace {

// How much of a row (or column) of the result one row (or column) of the environment covers.
struct Share
{
    int index;
    double weight;
};

// Split [from, to] at the edges k length / count; `measure` gives the weight of an interval.
template <class Measure>
std::vector<Share> shares(double from, double to, int count, double length, const Measure& measure)
{
    std::vector<Share> parts;
    const int first = std::clamp(int(from / length * count), 0, count - 1);
    for (int k = first; k < count && k * length / count < to; ++k) {
        const double low = std::max(from, k * length / count), high = std::min(to, (k + 1) * length / count);
        if (high > low)
            parts.push_back({ k, measure(low, high) });
    }
    return parts;
}

// The mean of the environment over each pixel of the result. False if a row cannot be read or `progress` stopped it.
bool reduce(std::vector<double>& sums, EnvironmentRows& rows, const Size& size, const Progress& progress)
{
    ++work_counts().filter_passes;
    const EnvironmentGrid& grid = rows.grid();
    const int width = size.width, height = size.height;
    const auto turn = [](double low, double high) { return high - low; };
    const auto zone = [](double low, double high) {
        return 2 * std::sin(0.5 * (low + high)) * std::sin(0.5 * (high - low)); // cos low - cos high
    };
    std::vector<std::vector<Share>> columns(size_t(grid.width));
    for (int i = 0; i < grid.width; ++i)
        columns[size_t(i)] = shares(grid.column_edge(i), grid.column_edge(i + 1), width, 2 * pi, turn);

    sums.assign(size_t(3) * width * height, 0.0);
    std::vector<double> across(size_t(3) * width), weights(height, 0.0);
    std::vector<float> row(size_t(3) * grid.width);
    for (int j = 0; j < grid.height; ++j) {
        if (!rows.read(j, row.data()) || (progress && !progress(double(j) / grid.height)))
            return false;
        std::fill(across.begin(), across.end(), 0.0);
        for (int i = 0; i < grid.width; ++i)
            for (const Share& part : columns[size_t(i)])
                for (int c = 0; c < 3; ++c)
                    across[size_t(3 * part.index + c)] += part.weight * row[size_t(3 * i + c)];
        for (const Share& part : shares(grid.row_edge(j), grid.row_edge(j + 1), height, pi, zone)) {
            weights[size_t(part.index)] += part.weight;
            double* sum = &sums[size_t(3) * width * part.index];
            for (size_t k = 0; k < across.size(); ++k)
                sum[k] += part.weight * across[k];
        }
    }
    for (int j = 0; j < height; ++j)
        for (int k = 0; k < 3 * width; ++k)
            sums[size_t(3) * width * j + k] *= width / (2 * pi * weights[size_t(j)]);
    return true;
}

} // namespace

bool make_radiance(OIIO::ImageBuf& dst, const Environment& env, const CfemParams& params, std::string& error,
                   const Progress& progress)
{
    if (!check_params(params, error))
        return false;
    EnvironmentRows rows(env, params.sanitize);
    if (!rows.open()) {
        error = rows.error();
        return false;
    }
    const std::optional<OneColor> color = find_one_color(env, params.sanitize);
    std::vector<double> means;
    const bool skip = color && params.skip_one_color;
    if (skip ? progress && !progress(1) : !reduce(means, rows, params.resolution, progress)) {
        error = rows.error().empty() ? "interrupted" : rows.error();
        return false;
    }
    if (color)
        fill(means, params.resolution, *color);
    OIIO::ImageSpec spec = describe_cfem_level(env.spec(), params, kStackLevels);
    record_sanitized(spec, color ? color->repaired : rows.bad_values());
    return set_filtered(dst, spec, means, true, error);
}

const OIIO::ImageBuf* find_radiance(OIIO::cspan<OIIO::ImageBuf> light)
{
    for (const OIIO::ImageBuf& image : light)
        if (image.spec().get_float_attribute("vmlight:lobe") == 1)
            return &image;
    return nullptr;
}

bool has_all_light(OIIO::cspan<OIIO::ImageBuf> light)
{
    return is_stack(light) || find_radiance(light);
}

} // namespace vmlight
