// SPDX-License-Identifier: Apache-2.0
/// The error of a picture against a noisy reference, with confidence intervals.
#pragma once

#include <OpenImageIO/span.h>

#include <cstdint>
#include <vector>

namespace vmlight::cost {

/// Number of batches for the jackknife.
constexpr int kBatches = 32;

/// Sums over some values (texels times channels) of a model m, its reference r and the reference's standard error s.
struct Batch
{
    double squares = 0; ///< of m - r
    double noise = 0; ///< s^2
    double difference = 0; ///< m - r
    double reference = 0; ///< r
    double weights = 0; ///< each of the sums is weighted

    /// @param weight   0 or more
    void add(double model, double truth, double standard_error, double weight = 1);
    void add(const Batch& other);
};

struct Estimate
{
    double value = 0;
    /// The 95 % confidence interval.
    double low = 0, high = 0;
};

struct Errors
{
    /// sqrt(max(0, mean((m - r)^2) - mean(s^2))) / mean(r)
    Estimate rmse;
    /// The same with each texel weighted by its visibility: creases, which few rays leave, count less.
    double rmse_by_visibility = 0;
    /// mean(m - r) / mean(r)
    Estimate bias;
    /// The 95th percentile of |m - r| / mean(r), including the reference's noise.
    double p95 = 0;
};

/// RMS error and bias, relative to the mean of the reference.
///
/// The intervals are from a jackknife over batches with Student's t: they cover the choice of texels and the rays of
/// bake and reference, not environments or rotations. That of `rmse` is computed for its square, which may be negative
/// within the noise, and clamped at 0.
///
/// @param batches  at least two with values. The sum of `reference` without any one of them must be above 0, or results
///                 are not finite; not checked
/// Source: B. Efron, "The Jackknife, the Bootstrap and Other Resampling Plans", SIAM 1982, chapter 3.
Errors errors_of(OIIO::cspan<Batch> batches);

/// The batch of a texel: a hash of its position, so that neighbours, whose errors are correlated, are in different
/// ones.
int batch_of(int x, int y);

/// The `q` quantile of `values`, q in [0, 1]; 0 if there are none. Reorders them.
double quantile(std::vector<float>& values, double q);

} // namespace vmlight::cost
