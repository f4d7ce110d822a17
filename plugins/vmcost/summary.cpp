// SPDX-License-Identifier: Apache-2.0
#include "summary.h"

#include <algorithm>

namespace vmlight::cost {
namespace {

Point mean_point(const std::vector<const Row*>& rows)
{
    Point point;
    point.setting = rows[0]->setting;
    point.bytes = rows[0]->bytes;
    const double share = 1 / double(rows.size());
    for (const Row* row : rows) {
        const Errors& errors = row->errors;
        point.rmse += share * errors.rmse.value;
        point.worst = std::max(point.worst, errors.rmse.value);
        point.rmse_half += share * std::max(errors.rmse.high - errors.rmse.value, errors.rmse.value - errors.rmse.low);
        point.bias += share * errors.bias.value;
        point.bias_half += share * (errors.bias.high - errors.bias.low) / 2;
        point.p95 += share * errors.p95;
        point.rmse_by_visibility += share * errors.rmse_by_visibility;
        point.bake += share * row->bake;
        point.light += share * row->light;
        point.shade += share * row->shade;
    }
    return point;
}

} // namespace

std::vector<Point> summarize(const std::vector<Row>& rows)
{
    std::vector<std::vector<const Row*>> groups;
    for (const Row& row : rows) {
        const auto same = [&](const auto& group) { return group[0]->setting == row.setting; };
        const auto found = std::find_if(groups.begin(), groups.end(), same);
        (found == groups.end() ? groups.emplace_back() : *found).push_back(&row);
    }
    std::vector<Point> points;
    for (const auto& group : groups)
        points.push_back(mean_point(group));
    return points;
}

std::vector<Point> curve(const std::vector<Point>& points, const std::string& model)
{
    std::vector<Point> found;
    for (const Point& point : points)
        if (point.setting.model == model && varies_samples_alone(point.setting))
            found.push_back(point);
    std::sort(found.begin(), found.end(),
              [](const Point& a, const Point& b) { return a.setting.samples < b.setting.samples; });
    return found;
}

std::vector<Point> pareto_front(std::vector<Point> points)
{
    std::sort(points.begin(), points.end(), [](const Point& a, const Point& b) {
        return std::make_pair(a.total(), a.rmse) < std::make_pair(b.total(), b.rmse);
    });
    std::vector<Point> front;
    for (const Point& point : points)
        if (front.empty() || point.rmse < front.back().rmse)
            front.push_back(point);
    return front;
}

const Point& knee(const std::vector<Point>& curve)
{
    double least = curve.back().rmse;
    size_t found = curve.size() - 1;
    for (size_t i = curve.size(); i-- > 0;) {
        least = std::min(least, curve[i].rmse);
        if (curve[i].rmse * (1 - kKneeGain) <= least)
            found = i;
    }
    return curve[found];
}

const Point* cheapest(const std::vector<Point>& points, double target)
{
    const Point* found = nullptr;
    for (const Point& point : points)
        if (point.bound() <= target && (!found || point.total() < found->total()))
            found = &point;
    return found;
}

const Point* nearest(const std::vector<Point>& points)
{
    const auto least = std::min_element(points.begin(), points.end(),
                                        [](const Point& a, const Point& b) { return a.bound() < b.bound(); });
    return least == points.end() ? nullptr : cheapest(points, least->bound() / (1 - kKneeGain));
}

std::vector<double> goals(const std::vector<Point>& points)
{
    constexpr double kRound[] = { 0.005, 0.01, 0.02, 0.03, 0.05, 0.07, 0.1, 0.15, 0.2, 0.3, 0.5, 0.7, 1 };
    constexpr size_t kGoals = 3;
    std::vector<double> found;
    for (const double goal : kRound)
        if (found.size() < kGoals && cheapest(points, goal))
            found.push_back(goal);
    return found;
}

double typical_spread(const std::vector<Row>& rows)
{
    std::vector<double> spreads;
    for (const Row& row : rows)
        if (row.spread > 0)
            spreads.push_back(row.spread);
    if (spreads.empty())
        return 0;
    const auto middle = spreads.begin() + long(spreads.size() / 2);
    std::nth_element(spreads.begin(), middle, spreads.end());
    return *middle;
}

} // namespace vmlight::cost
