// SPDX-License-Identifier: Apache-2.0
/// The statistics of vmcost against closed forms and against chance.
#include "cases.h"

#include <vmcost/statistics.h>

#include <gtest/gtest.h>

#include <cmath>
#include <random>

using namespace vmlight::cost;

namespace {

// A model that is off by `offset` and normal noise of width `spread`, against a reference of mean 2 whose own noise has
// width `noise`.
std::vector<Batch> synthetic(int values, double offset, double spread, double noise, unsigned seed)
{
    std::mt19937 random(seed);
    std::normal_distribution<double> normal;
    std::vector<Batch> batches(kBatches);
    for (int i = 0; i < values; ++i) {
        const double truth = 2 + 0.5 * std::sin(0.01 * i);
        const double model = truth + offset + spread * normal(random);
        batches[size_t(i % kBatches)].add(model, truth + noise * normal(random), noise);
    }
    return batches;
}

bool holds(const Estimate& estimate, double value)
{
    return estimate.low <= value && value <= estimate.high;
}

} // namespace

TEST(CostStatistics, AnOffsetAloneIsTheErrorAndTheBias)
{
    const Errors errors = errors_of(synthetic(6400, 0.2, 0, 0, 1));
    EXPECT_NEAR(errors.bias.value, 0.1, 1e-3); // the mean of the reference is 2 within 1e-3
    EXPECT_NEAR(errors.rmse.value, 0.1, 1e-3);
    EXPECT_LT(errors.rmse.low, errors.rmse.value);
    EXPECT_GT(errors.rmse.high, errors.rmse.value);
}

TEST(CostStatistics, TheReferencesOwnNoiseIsTakenOff)
{
    // sqrt(0.2^2 + 0.3^2) / 2 is 0.180; with noise of 1 left in it would be 0.53.
    const Errors errors = errors_of(synthetic(400000, 0.2, 0.3, 1, 2));
    EXPECT_NEAR(errors.rmse.value, std::sqrt(0.13) / 2, 5e-3);
    EXPECT_NEAR(errors.bias.value, 0.1, 4e-3);
    EXPECT_TRUE(holds(errors.rmse, std::sqrt(0.13) / 2)) << errors.rmse.low << " " << errors.rmse.high;
}

TEST(CostStatistics, AnErrorBelowTheNoiseIsZeroOrMoreAndItsIntervalHoldsZero)
{
    for (unsigned seed = 0; seed < 20; ++seed) {
        const Errors errors = errors_of(synthetic(3200, 0, 0, 1, seed));
        EXPECT_GE(errors.rmse.value, 0);
        EXPECT_EQ(errors.rmse.low, 0);
        EXPECT_LT(errors.rmse.high, 0.2); // the noise itself is 0.5
    }
}

TEST(CostStatistics, IntervalsHoldTheTruthAsOftenAsTheySay)
{
    // Of 1000 intervals of 95 %, 950 hold it, give or take six standard deviations, which are 41.
    constexpr int kRuns = cases(1000, 50);
    int rmse = 0, bias = 0;
    for (unsigned run = 0; run < kRuns; ++run) {
        const Errors errors = errors_of(synthetic(3200, 0.1, 0.4, 0.5, 1000 + run));
        rmse += holds(errors.rmse, std::sqrt(0.17) / 2);
        bias += holds(errors.bias, 0.05);
    }
    const double deviation = std::sqrt(kRuns * 0.95 * 0.05);
    EXPECT_NEAR(rmse, 0.95 * kRuns, 6 * deviation);
    EXPECT_NEAR(bias, 0.95 * kRuns, 6 * deviation);
}

TEST(CostStatistics, EmptyBatchesDoNotCount)
{
    std::vector<Batch> batches = synthetic(3200, 0.2, 0.3, 0, 3);
    const Errors before = errors_of(batches);
    batches.resize(2 * kBatches);
    const Errors after = errors_of(batches);
    EXPECT_EQ(before.rmse.high, after.rmse.high);
    EXPECT_EQ(before.bias.low, after.bias.low);
}

TEST(CostStatistics, TheIntervalOfAMeanIsStudents)
{
    // Over batches of equal weight the jackknife is the mean's own standard error; 2.0395 is Student's for 31 degrees.
    std::vector<Batch> batches(kBatches);
    double squares = 0;
    for (int i = 0; i < kBatches; ++i) {
        batches[size_t(i)].add(10 + i, 10, 0);
        squares += (i - 15.5) * (i - 15.5);
    }
    const double standard_error = std::sqrt(squares / 31 / 32) / 10;
    const Errors errors = errors_of(batches);
    EXPECT_NEAR(errors.bias.value, 1.55, 1e-12);
    EXPECT_NEAR(errors.bias.high - errors.bias.value, 2.0395 * standard_error, 1e-4 * standard_error);
    EXPECT_NEAR(errors.bias.value - errors.bias.low, 2.0395 * standard_error, 1e-4 * standard_error);
}

TEST(CostStatistics, NeighboursPartAndBatchesAreOfLikeSize)
{
    std::vector<int> counts(kBatches);
    int together = 0;
    for (int y = 0; y < 128; ++y)
        for (int x = 0; x < 128; ++x) {
            ++counts[size_t(batch_of(x, y))];
            together += batch_of(x, y) == batch_of(x + 1, y);
        }
    for (const int count : counts)
        EXPECT_NEAR(count, 512, 6 * 22.3); // six standard deviations
    EXPECT_NEAR(together, 512, 6 * 22.3);
}

TEST(CostStatistics, AQuantileIsTheValueThatItsShareIsBelow)
{
    std::vector<float> values;
    for (int i = 0; i < 1000; ++i)
        values.push_back(float(i * 7 % 1000)); // each of 0..999 once
    EXPECT_EQ(quantile(values, 0.95), 950);
    EXPECT_EQ(quantile(values, 0), 0);
    EXPECT_EQ(quantile(values, 1), 999);
    values.clear();
    EXPECT_EQ(quantile(values, 0.95), 0);
}
