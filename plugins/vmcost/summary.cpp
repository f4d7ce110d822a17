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

bool could_reach(const std::vector<Point>& points, double target)
{
    return std::any_of(points.begin(), points.end(), [&](const Point& point) { return point.rmse <= target; });
}

} // namespace vmlight::cost
