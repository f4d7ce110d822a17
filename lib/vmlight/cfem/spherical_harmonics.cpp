// SPDX-License-Identifier: Apache-2.0
#include <vmlight/cfem/spherical_harmonics.h>

#include <vmlight/base/parallel.h>
#include <vmlight/base/work_counts.h>
#include <vmlight/math/harmonics.h>
#include <vmlight/math/latlong.h>

#include <algorithm>
#include <cmath>

namespace vmlight {

using latlong::pi;

namespace {

// Rows read before they are projected on threads.
constexpr int kBlockRows = 64;
// Four nodes per strip of latitude follow P_lm of the highest band in the coarsest strips to 1e-6: band 63 in 1/128 of
// pi.
constexpr int kNodes = 4;
constexpr int kLeastStrips = 128;

// Normalised associated Legendre functions of one m, for l = m, m + 1, ...: Int P_lm^2 over the sphere is 1.
// The recurrence in l at fixed m is stable upwards.
class Legendre
{
public:
    Legendre(int m, double cos_theta, double sin_theta)
        : m_m(m)
        , m_l(m)
        , m_cos(cos_theta)
        , m_value(std::sqrt(1 / (4 * pi)))
    {
        for (int k = 1; k <= m; ++k)
            m_value *= sin_theta * std::sqrt((2 * k + 1) / (2.0 * k));
    }
    double value() const { return m_value; }
    void next()
    {
        const int l = ++m_l;
        const double square = double(l) * l, m2 = double(m_m) * m_m;
        const double factor = std::sqrt((4 * square - 1) / (square - m2));
        const double below = (l - 1.0) * (l - 1.0);
        const double next = factor * (m_cos * m_value - std::sqrt((below - m2) / (4 * below - 1)) * m_previous);
        m_previous = m_value;
        m_value = next;
    }

private:
    int m_m, m_l;
    double m_cos, m_value, m_previous = 0;
};

// Y_l,m and Y_l,-m carry sqrt 2, Y_l0 does not.
double azimuth_norm(int m)
{
    return m == 0 ? 1 : std::sqrt(2.0);
}

size_t place(int l, int m)
{
    return 3 * (size_t(l) * l + l + m);
}

} // namespace

bool project_harmonics(std::vector<double>& coefficients, int order, const EnvironmentGrid& grid, const ReadRow& read,
                       int nthreads, const Progress& progress)
{
    ++work_counts().filter_passes;
    const int width = grid.width;
    // Int over a pixel of cos m phi is a difference of sin m phi / m at its edges.
    std::vector<double> cosine(size_t(order) * (width + 1)), sine(size_t(order) * (width + 1));
    for (int m = 0; m < order; ++m)
        for (int i = 0; i <= width; ++i) {
            const double phi = i == width ? 0 : grid.column_edge(i);
            cosine[size_t(m) * (width + 1) + i] = m == 0 ? grid.column_edge(i) : std::sin(m * phi) / m;
            sine[size_t(m) * (width + 1) + i] = m == 0 ? 0 : -std::cos(m * phi) / m;
        }

    // Per row of the environment and m: the integrals of L cos m phi and of L sin m phi.
    struct Azimuth
    {
        double cosine[3], sine[3];
    };
    std::vector<Azimuth> azimuth(size_t(grid.height) * order);
    std::vector<float> pixels(size_t(3) * width * kBlockRows);
    for (int first = 0; first < grid.height; first += kBlockRows) {
        const int rows = std::min(kBlockRows, grid.height - first);
        for (int r = 0; r < rows; ++r)
            if (!read(first + r, &pixels[size_t(3) * width * r]))
                return false;
        const auto project_row = [&](int64_t r, int) {
            for (int m = 0; m < order; ++m) {
                const float* pixel = &pixels[size_t(3) * width * r];
                const double* c = &cosine[size_t(m) * (width + 1)];
                const double* s = &sine[size_t(m) * (width + 1)];
                Azimuth sum {};
                for (int i = 0; i < width; ++i, pixel += 3)
                    for (int k = 0; k < 3; ++k) {
                        sum.cosine[k] += pixel[k] * (c[i + 1] - c[i]);
                        sum.sine[k] += pixel[k] * (s[i + 1] - s[i]);
                    }
                azimuth[size_t(first + r) * order + m] = sum;
            }
        };
        const auto report = [&](double share) { return progress((first + share * rows) / grid.height); };
        if (!parallel_items(rows, nthreads, project_row, progress ? Progress(report) : Progress()))
            return false;
    }

    const LatitudeRule rule(kNodes);
    const int strips = std::max(kLeastStrips, 2 * order);
    const int parts = (strips + grid.height - 1) / grid.height;
    std::vector<LatitudeNode> nodes;
    for (int r = 0; r < grid.height; ++r) {
        const double theta = grid.row_edge(r), step = (grid.row_edge(r + 1) - theta) / parts;
        for (int part = 0; part < parts; ++part)
            rule.append(nodes, theta + part * step, theta + (part + 1) * step);
    }
    const size_t nodes_per_row = size_t(parts) * kNodes;
    coefficients.assign(size_t(3) * order * order, 0.0);
    // One m to one thread, rows in order: the sums are the same for any number of threads.
    parallel_items(order, nthreads, [&](int64_t item, int) {
        const int m = int(item);
        const double norm = azimuth_norm(m);
        for (size_t n = 0; n < nodes.size(); ++n) {
            const Azimuth& light = azimuth[n / nodes_per_row * order + m];
            Legendre legendre(m, nodes[n].cos_theta, nodes[n].sin_theta);
            for (int l = m; l < order; ++l, legendre.next()) {
                const double weight = nodes[n].weight * norm * legendre.value();
                for (int k = 0; k < 3; ++k) {
                    coefficients[place(l, m) + k] += weight * light.cosine[k];
                    if (m > 0)
                        coefficients[place(l, -m) + k] += weight * light.sine[k];
                }
            }
        }
    });
    return true;
}

void evaluate_harmonics(std::vector<double>& rgb, const Size& resolution, const std::vector<double>& coefficients,
                        int order, int nthreads)
{
    const int width = resolution.width;
    rgb.assign(size_t(3) * width * resolution.height, 0.0);
    std::vector<double> cosine(size_t(order) * width), sine(size_t(order) * width);
    for (int m = 0; m < order; ++m)
        for (int x = 0; x < width; ++x) {
            const double phi = 2 * pi * (x + 0.5) / width;
            cosine[size_t(m) * width + x] = std::cos(m * phi);
            sine[size_t(m) * width + x] = std::sin(m * phi);
        }
    parallel_items(resolution.height, nthreads, [&](int64_t y, int) {
        const double theta = pi * (y + 0.5) / resolution.height;
        for (int m = 0; m < order; ++m) {
            double c[3] = {}, s[3] = {};
            Legendre legendre(m, std::cos(theta), std::sin(theta));
            for (int l = m; l < order; ++l, legendre.next())
                for (int k = 0; k < 3; ++k) {
                    const double value = azimuth_norm(m) * legendre.value();
                    c[k] += value * coefficients[place(l, m) + k];
                    s[k] += m > 0 ? value * coefficients[place(l, -m) + k] : 0;
                }
            double* pixel = &rgb[size_t(3) * width * y];
            for (int x = 0; x < width; ++x, pixel += 3)
                for (int k = 0; k < 3; ++k)
                    pixel[k] += c[k] * cosine[size_t(m) * width + x] + s[k] * sine[size_t(m) * width + x];
        }
    });
}

bool filter_harmonics(std::vector<double>& rgb, const Size& resolution, int order, const EnvironmentGrid& grid,
                      const ReadRow& read, int nthreads, const Progress& progress, double (*eigenvalue)(int band))
{
    std::vector<double> coefficients;
    if (!project_harmonics(coefficients, order, grid, read, nthreads, progress))
        return false;
    for (int l = 0; l < order; ++l)
        for (int i = 0; i < 3 * (2 * l + 1); ++i)
            coefficients[place(l, -l) + i] *= eigenvalue(l);
    evaluate_harmonics(rgb, resolution, coefficients, order, nthreads);
    return true;
}

} // namespace vmlight
