// SPDX-License-Identifier: Apache-2.0
#include <vmlight/frame/pixel_samples.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <numeric>

namespace vmlight {
namespace {

constexpr double kPi = 3.14159265358979323846;

// A filter as a density along one axis: positive within `radius` pixels of the centre.
struct Filter
{
    const char *name, *meaning;
    double radius;
    double (*density)(double x); // x in [-1, 1] of the radius
};

const std::array<Filter, 4> kFilters { {
    { "blackman-harris", "smooth, 3 pixels wide: the default of most renderers", 1.5,
      [](double x) {
          const double a = kPi * (x + 1);
          return 0.35875 - 0.48829 * std::cos(a) + 0.14128 * std::cos(2 * a) - 0.01168 * std::cos(3 * a);
      } },
    { "gaussian", "softer: standard deviation of half a pixel", 1.5, [](double x) { return std::exp(-4.5 * x * x); } },
    { "triangle", "2 pixels wide", 1, [](double x) { return 1 - std::abs(x); } },
    { "box", "the pixel's square: sharpest, and what other programs' box filters give", 0.5,
      [](double) { return 1.0; } },
} };

// The point below which the share `u` of the filter lies, in pixels.
double warp(const Filter& filter, double u)
{
    constexpr int kSteps = 4096; // even, and symmetric: 1/2 is the centre
    double total = 0;
    std::array<double, kSteps + 1> sum {};
    for (int i = 0; i < kSteps; ++i) {
        total += filter.density((i + 0.5) / kSteps * 2 - 1);
        sum[i + 1] = total;
    }
    const bool is_upper = u > 0.5;
    const double share = (is_upper ? 1 - u : u) * total;
    int i = 0;
    while (i < kSteps && sum[i + 1] < share)
        ++i;
    const double x = ((i + (share - sum[i]) / (sum[i + 1] - sum[i])) / kSteps * 2 - 1) * filter.radius;
    return u == 0.5 ? 0 : is_upper ? -x : x;
}

const Filter& filter_named(const std::string& name)
{
    const auto found
        = std::find_if(kFilters.begin(), kFilters.end(), [&](const Filter& filter) { return filter.name == name; });
    return found == kFilters.end() ? kFilters[0] : *found;
}

// The step of a lattice of `count` points along the second axis: without a common divisor, near the golden section.
int lattice_step(int count)
{
    const int golden = int(std::lround(count * 0.6180339887498949));
    for (int distance = 0;; ++distance)
        for (const int step : { golden + distance, golden - distance })
            if (step >= 1 && std::gcd(step, count) == 1)
                return step;
}

} // namespace

Choices pixel_filter_choices()
{
    Choices choices;
    for (const Filter& filter : kFilters)
        choices.choices.push_back({ filter.name, filter.meaning });
    return choices;
}

double filter_radius(const std::string& filter)
{
    return filter_named(filter).radius;
}

double filter_variance(const std::string& filter)
{
    constexpr int kSteps = 4096;
    const Filter& shape = filter_named(filter);
    double sum = 0, squares = 0;
    for (int i = 0; i < kSteps; ++i) {
        const double x = (i + 0.5) / kSteps * 2 - 1, density = shape.density(x);
        sum += density;
        squares += density * x * x;
    }
    return squares / sum * shape.radius * shape.radius;
}

std::vector<PixelSample> pixel_samples(int count, const std::string& filter)
{
    const Filter* found = &filter_named(filter);
    std::vector<double> position(static_cast<size_t>(count));
    for (int i = 0; i < count; ++i)
        position[i] = warp(*found, (i + 0.5) / count);
    const int step = lattice_step(count);
    std::vector<PixelSample> samples(static_cast<size_t>(count));
    for (int i = 0; i < count; ++i)
        samples[i] = { position[i], position[int64_t(i) * step % count] };
    return samples;
}

} // namespace vmlight
