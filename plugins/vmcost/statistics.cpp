// SPDX-License-Identifier: Apache-2.0
#include "statistics.h"

#include <OpenImageIO/hash.h>

#include <algorithm>
#include <cmath>

namespace vmlight::cost {
namespace {

// The 97.5 % quantile of Student's t distribution: Cornish-Fisher expansion, within 1e-3 from 5 degrees of freedom.
double student(int freedom)
{
    constexpr double z = 1.959963985;
    const double n = freedom, z3 = z * z * z, z5 = z3 * z * z, z7 = z5 * z * z;
    return z + (z3 + z) / (4 * n) + (5 * z5 + 16 * z3 + 3 * z) / (96 * n * n)
        + (3 * z7 + 19 * z5 + 17 * z3 - 15 * z) / (384 * n * n * n);
}

double mean_square(const Batch& sum)
{
    const double mean = sum.reference / sum.weights;
    return (sum.squares - sum.noise) / sum.weights / (mean * mean);
}

double relative_bias(const Batch& sum)
{
    return sum.difference / sum.reference;
}

Batch sum_of(OIIO::cspan<Batch> batches, int without)
{
    Batch sum;
    for (int i = 0; i < int(batches.size()); ++i)
        if (i != without)
            sum.add(batches[i]);
    return sum;
}

template <class Statistic> Estimate jackknife(OIIO::cspan<Batch> batches, Statistic&& statistic)
{
    std::vector<double> left_out;
    for (int i = 0; i < int(batches.size()); ++i)
        if (batches[i].weights > 0)
            left_out.push_back(statistic(sum_of(batches, i)));
    const double count = double(left_out.size());
    double mean = 0, squares = 0;
    for (const double value : left_out)
        mean += value / count;
    for (const double value : left_out)
        squares += (value - mean) * (value - mean);
    const double half = student(int(left_out.size()) - 1) * std::sqrt((count - 1) / count * squares);
    const double value = statistic(sum_of(batches, -1));
    return { value, value - half, value + half };
}

} // namespace

void Batch::add(double model, double truth, double standard_error, double weight)
{
    squares += weight * (model - truth) * (model - truth);
    noise += weight * standard_error * standard_error;
    difference += weight * (model - truth);
    reference += weight * truth;
    weights += weight;
}

void Batch::add(const Batch& other)
{
    squares += other.squares;
    noise += other.noise;
    difference += other.difference;
    reference += other.reference;
    weights += other.weights;
}

Errors errors_of(OIIO::cspan<Batch> batches)
{
    Errors errors;
    const Estimate square = jackknife(batches, mean_square);
    const auto root = [](double x) { return std::sqrt(std::max(0.0, x)); };
    errors.rmse = { root(square.value), root(square.low), root(square.high) };
    errors.bias = jackknife(batches, relative_bias);
    return errors;
}

int batch_of(int x, int y)
{
    return int(OIIO::bjhash::bjfinal(uint32_t(x), uint32_t(y)) % kBatches);
}

double quantile(std::vector<float>& values, double q)
{
    if (values.empty())
        return 0;
    const size_t at = std::min(values.size() - 1, size_t(q * double(values.size())));
    std::nth_element(values.begin(), values.begin() + long(at), values.end());
    return values[at];
}

} // namespace vmlight::cost
