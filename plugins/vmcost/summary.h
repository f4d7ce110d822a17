// SPDX-License-Identifier: Apache-2.0
/// Summary over rows: averages over environments, the best setting for a budget, and where more rays stop paying off.
#pragma once

#include "row.h"

#include <string>
#include <vector>

namespace vmlight::cost {

/// One setting, averaged over all environments.
struct Point
{
    Setting setting;
    double rmse = 0, worst = 0; ///< mean and maximum over environments
    /// Half of the 95 % confidence interval: the mean over environments, an upper bound however their errors correlate.
    /// For `rmse`, which is clamped at 0, the longer half.
    double rmse_half = 0, bias_half = 0;
    double bias = 0; ///< mean
    double p95 = 0; ///< mean
    double rmse_by_visibility = 0; ///< mean
    double bake = 0, light = 0, shade = 0; ///< seconds; means
    int bytes = 0;

    /// Upper end of the confidence interval of the error.
    double bound() const { return rmse + rmse_half; }
    /// Seconds to make this many pictures of one environment, each at another rotation.
    double total(int pictures = 1) const { return bake + light + pictures * shade; }
};

/// One point per setting, in order of first occurrence.
std::vector<Point> summarize(const std::vector<Row>& rows);

/// The points of one model that differ in samples only, fewest first.
std::vector<Point> curve(const std::vector<Point>& points, const std::string& model);

/// The Pareto front of time and error, by time: total() increases, rmse decreases.
std::vector<Point> pareto_front(std::vector<Point> points);

/// Beyond its knee a model improves by less than this fraction of its error.
constexpr double kKneeGain = 0.02;

/// The first point of a non-empty curve whose error is within kKneeGain of the minimum from there on.
const Point& knee(const std::vector<Point>& curve);

/// The fastest point whose bound() is at most `target`, or nullptr.
const Point* cheapest(const std::vector<Point>& points, double target);

/// The fastest point whose bound() is within kKneeGain of the minimum, or nullptr if there are no points.
const Point* nearest(const std::vector<Point>& points);

/// Round errors to choose a setting for, least first: the least that a point reaches, and the next two. At most 1, so
/// empty if no point reaches that.
std::vector<double> goals(const std::vector<Point>& points);

/// Above this typical_spread() the machine was too busy for its timings.
constexpr double kBusySpread = 0.25;

/// The median spread of the timings that were repeated, or 0 if none was.
double typical_spread(const std::vector<Row>& rows);

} // namespace vmlight::cost
