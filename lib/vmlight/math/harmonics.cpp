// SPDX-License-Identifier: Apache-2.0
#include <vmlight/math/harmonics.h>

#include <vmlight/math/latlong.h>

#include <array>
#include <cmath>

namespace vmlight {

using Imath::V3d;
using latlong::pi;

Harmonics::Harmonics(int order)
    : m_order(order)
    , m_steps(size_t(order) * size_t(order))
    , m_first(size_t(order))
{
    double first = std::sqrt(1 / (4 * pi));
    for (int m = 0; m < order; ++m) {
        if (m > 0)
            first *= std::sqrt((2 * m + 1) / (2.0 * m));
        m_first[size_t(m)] = float(m > 0 ? first * std::sqrt(2.0) : first);
        for (int l = m + 1; l < order; ++l) {
            const double square = double(l) * l, m2 = double(m) * m, below = (l - 1.0) * (l - 1.0);
            const double rise = std::sqrt((4 * square - 1) / (square - m2));
            const double fall = l > m + 1 ? rise * std::sqrt((below - m2) / (4 * below - 1)) : 0;
            m_steps[size_t(l * order + m)] = { float(rise), float(fall) };
        }
    }
}

void Harmonics::evaluate(const float* x, const float* y, const float* z, float* values) const
{
    // sin^m theta times cos and sin of m phi, where cos phi = -z and sin phi = x.
    std::array<float, kLanes> cosine, sine, before, last;
    cosine.fill(1);
    sine.fill(0);
    for (int m = 0; m < m_order; ++m) {
        if (m > 0)
            for (int i = 0; i < kLanes; ++i) {
                const float c = cosine[size_t(i)], s = sine[size_t(i)];
                cosine[size_t(i)] = -z[i] * c - x[i] * s;
                sine[size_t(i)] = x[i] * c - z[i] * s;
            }
        before.fill(0);
        last.fill(m_first[size_t(m)]);
        for (int l = m; l < m_order; ++l) {
            const Step step = m_steps[size_t(l * m_order + m)];
            float* even = values + (l * l + l + m) * kLanes;
            float* odd = values + (l * l + l - m) * kLanes;
            for (int i = 0; i < kLanes; ++i) {
                const size_t k = size_t(i);
                const float legendre = l == m ? last[k] : step.rise * y[i] * last[k] - step.fall * before[k];
                before[k] = l == m ? 0 : last[k];
                last[k] = legendre;
                odd[i] = legendre * sine[k]; // m = 0: the same element, overwritten by the next line
                even[i] = legendre * cosine[k];
            }
        }
    }
}

std::vector<double> rotate_harmonics(const std::vector<double>& coefficients, int order, const Rotation& rotation)
{
    const Harmonics harmonics(order);
    constexpr int kLanes = Harmonics::kLanes;
    const int rows = 2 * order, columns = (2 * order + kLanes - 1) / kLanes * kLanes;
    std::vector<double> rotated(coefficients.size(), 0.0);
    std::vector<float> here(size_t(harmonics.count()) * kLanes), there(here.size());
    std::array<float, kLanes> x, y, z, rx, ry, rz;
    for (int row = 0; row < rows; ++row) {
        const double theta = pi * (2 * row + 1) / (4 * order);
        double weight = 0;
        for (int k = 0; k < order; ++k)
            weight += std::sin((2 * k + 1) * theta) / (2 * k + 1);
        weight *= 2.0 / order * std::sin(theta) * 2 * pi / columns;
        for (int column = 0; column < columns; column += kLanes) {
            for (int i = 0; i < kLanes; ++i) {
                const V3d w = latlong::direction((column + i) / double(columns), theta / pi), r = rotate(rotation, w);
                const size_t k = size_t(i);
                x[k] = float(w.x), y[k] = float(w.y), z[k] = float(w.z);
                rx[k] = float(r.x), ry[k] = float(r.y), rz[k] = float(r.z);
            }
            harmonics.evaluate(x.data(), y.data(), z.data(), here.data());
            harmonics.evaluate(rx.data(), ry.data(), rz.data(), there.data());
            for (int i = 0; i < kLanes; ++i)
                for (int c = 0; c < 3; ++c) {
                    double value = 0;
                    for (int k = 0; k < harmonics.count(); ++k)
                        value += coefficients[size_t(3 * k + c)] * double(there[size_t(k * kLanes + i)]);
                    for (int k = 0; k < harmonics.count(); ++k)
                        rotated[size_t(3 * k + c)] += weight * value * double(here[size_t(k * kLanes + i)]);
                }
        }
    }
    return rotated;
}

double cosine_eigenvalue(int l)
{
    if (l % 2 == 1)
        return l == 1 ? 2.0 / 3 : 0;
    double value = 1;
    for (int k = 0; k < l; k += 2)
        value *= (1.0 - k) / (k + 4.0);
    return value;
}

double sine_eigenvalue(int l)
{
    if (l % 2 == 1)
        return 0;
    double a = 1;
    for (int k = 1; 2 * k <= l; ++k)
        a *= (2 * k - 1) / (2.0 * k);
    const int n = l / 2;
    return -a * a / ((2 * n - 1.0) * (n + 1));
}

} // namespace vmlight
