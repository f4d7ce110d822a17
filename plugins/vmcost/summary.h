// SPDX-License-Identifier: Apache-2.0
/// What rows mean together: means over environments, the best that a budget buys, and where more rays stop paying.
#pragma once

#include "row.h"

#include <string>
#include <vector>

namespace vmlight::cost {

/// One setting over all environments.
struct Point
{
    Setting setting;
    double rmse = 0, worst = 0; ///< mean and largest of the environments
    /// Half the interval of 95 %: the mean of those of the environments, which bounds that of the mean however their
    /// errors go together. Of `rmse`, which is cut off at 0, the longer half.
    double rmse_half = 0, bias_half = 0;
    double bias = 0; ///< mean
    double p95 = 0; ///< mean
    double bake = 0, light = 0, shade = 0; ///< seconds; means
    int bytes = 0;

    /// What the error is surely below, as far as the interval is sure.
    double bound() const { return rmse + rmse_half; }
    /// Seconds to so many pictures of one environment, each at another rotation.
    double total(int pictures = 1) const { return bake + light + pictures * shade; }
};

/// One point a setting, in the order in which settings first come.
std::vector<Point> summarize(const std::vector<Row>& rows);

/// The points of one model that differ in samples alone, fewest first.
std::vector<Point> curve(const std::vector<Point>& points, const std::string& model);

/// Those than which no other takes less time and errs less, or as much, by time: total() grows, rmse falls.
std::vector<Point> pareto_front(std::vector<Point> points);

/// A model gains less than this share of its error beyond its knee.
constexpr double kKneeGain = 0.02;

/// The first point of a curve (not empty) whose error is within kKneeGain of the least that this or any later one has.
const Point& knee(const std::vector<Point>& curve);

/// Of those that surely, by bound(), err no more than `target` the one that takes least time; nullptr if none does.
const Point* cheapest(const std::vector<Point>& points, double target);

/// The one that takes least time of those whose bound() is least, but for kKneeGain; nullptr if there is none.
const Point* nearest(const std::vector<Point>& points);

/// Does one seem to err no more than `target`? Where cheapest() has none, the reference is too noisy to tell.
bool may_reach(const std::vector<Point>& points, double target);

} // namespace vmlight::cost
