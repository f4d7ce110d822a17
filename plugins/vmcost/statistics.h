// SPDX-License-Identifier: Apache-2.0
/// How far a picture is from a reference that is itself noisy, and how sure that is.
#pragma once

#include <OpenImageIO/span.h>

#include <cstdint>
#include <vector>

namespace vmlight::cost {

/// Texels are dealt to so many batches.
constexpr int kBatches = 32;

/// Sums over some values (texels times channels) of a model m, its reference r and the reference's standard error s.
struct Batch
{
    double squares = 0; ///< of m - r
    double noise = 0; ///< s^2
    double difference = 0; ///< m - r
    double reference = 0; ///< r
    int64_t values = 0;

    void add(double model, double truth, double standard_error);
    void add(const Batch& other);
};

struct Estimate
{
    double value = 0;
    /// Of the interval of 95 %.
    double low = 0, high = 0;
};

struct Errors
{
    /// sqrt(max(0, mean((m - r)^2) - mean(s^2))) / mean(r)
    Estimate rmse;
    /// mean(m - r) / mean(r)
    Estimate bias;
    /// What 95 % of |m - r| / mean(r) are below, the reference's noise included.
    double p95 = 0;
};

/// The root mean square error and the bias, relative to the mean of the reference.
///
/// The intervals are Student's, from the jackknife over batches: they cover what another choice of texels of the same
/// surface, other rays of the bake and other rays of the reference would have changed; not another environment or
/// rotation. The one of `rmse` is made of its square, which may be 0 or below within the noise, and cut off at 0.
///
/// @param batches  of which two or more hold values; the sum of `reference` is above 0 without any one of them, or
///                 what is returned is not finite. Not checked
/// Source: B. Efron, "The Jackknife, the Bootstrap and Other Resampling Plans", SIAM 1982, chapter 3.
Errors errors_of(OIIO::cspan<Batch> batches);

/// The batch of a texel: a hash of where it is, so that neighbours, whose errors are alike, part.
int batch_of(int x, int y);

/// The value that a share `q` of `values` is below, in [0, 1]. Sorts them partly; 0 if there is none.
double quantile(std::vector<float>& values, double q);

} // namespace vmlight::cost
