// SPDX-License-Identifier: Apache-2.0
#include <vmlight/mesh/import/alembic/curves.h>

#include <vmlight/base/format.h>
#include <vmlight/base/text_format.h>
#include <vmlight/mesh/import/alembic/error.h>

namespace vmlight::alembic {
namespace {

constexpr size_t kWrap = 1; // of "curveBasisAndType": type, wrap, basis

bool are_closed(const AbcA::CompoundPropertyReaderPtr& geom, Moment& moment)
{
    const auto kind = find_scalar(geom, "curveBasisAndType");
    if (!kind)
        return false;
    const std::vector<uint8_t> numbers = read_scalar<uint8_t>(*kind, samples_at(*kind, moment).first);
    return numbers.size() > kWrap && numbers[kWrap] != 0;
}

std::vector<uint32_t> read_ends(AbcA::ArrayPropertyReader& counts, size_t points, Moment& moment)
{
    std::vector<uint32_t> ends;
    uint64_t end = 0;
    for (const int32_t count : read_array<int32_t>(counts, samples_at(counts, moment).first)) {
        if (count < 2)
            throw Error(format("curve {} has {}: a strand has at least two", ends.size(),
                               count_text(count, "point", "points")));
        if (uint64_t(count) > points - end)
            throw Error(format("curve {} has {} points, but only {} are left", ends.size(), count, points - end));
        end += uint64_t(count);
        ends.push_back(uint32_t(end));
    }
    if (end != points)
        throw Error(format("its curves have {} points, but there are {}", end, points));
    return ends;
}

// A number for each point, from one for each point, for each curve or for all; empty if it is none of these.
std::vector<double> spread(const std::vector<float>& values, const std::vector<uint32_t>& ends, size_t points)
{
    if (values.size() == points)
        return { values.begin(), values.end() };
    if (values.size() == 1)
        return std::vector<double>(points, double(values[0]));
    std::vector<double> all;
    if (values.size() == ends.size())
        for (size_t curve = 0; curve < ends.size(); ++curve)
            all.resize(ends[curve], double(values[curve]));
    return all;
}

std::vector<double> read_widths(const AbcA::CompoundPropertyReaderPtr& geom, const Curves& curves, Moment& moment,
                                bool blended)
{
    const auto indexed = find_compound(geom, "width");
    const auto values = indexed ? find_array(indexed, ".vals") : find_array(geom, "width");
    if (!values || !holds_floats(*values, 1))
        return {};
    const SamplePair pair = samples_at(*values, moment);
    std::vector<float> numbers = read_array<float>(*values, pair.first);
    if (blended && pair.weight > 0)
        numbers = blend(std::move(numbers), read_array<float>(*values, pair.second), pair.weight);
    if (const auto indices = find_array(indexed, ".indices")) {
        std::vector<float> chosen;
        for (const uint32_t index : read_array<uint32_t>(*indices, samples_at(*indices, moment).first)) {
            if (index >= numbers.size())
                throw Error(format("\"width\" uses value {}, but there are only {}", index, numbers.size()));
            chosen.push_back(numbers[index]);
        }
        numbers = std::move(chosen);
    }
    return spread(numbers, curves.ends, curves.points.size());
}

} // namespace

bool is_curves(const AbcA::ObjectHeader& header)
{
    return header.getMetaData().get("schema") == "AbcGeom_Curve_v2";
}

Curves read_curves(AbcA::ObjectReader& object, Moment& moment)
{
    Curves curves;
    const auto geom = find_compound(object.getProperties(), ".geom");
    const auto points = find_array(geom, "P"), counts = find_array(geom, "nVertices");
    if (!points || !counts)
        throw Error("has no \"P\" or no \"nVertices\"");
    if (are_closed(geom, moment))
        throw Error("has closed curves, which are no strands");
    const SamplePair pair = samples_at(*points, moment);
    std::vector<float> numbers = read_array<float>(*points, pair.first, 3);
    curves.ends = read_ends(*counts, numbers.size() / 3, moment);
    if (pair.weight > 0 && counts->isConstant())
        numbers = blend(std::move(numbers), read_array<float>(*points, pair.second, 3), pair.weight);
    for (size_t i = 0; i < numbers.size(); i += 3)
        curves.points.emplace_back(numbers[i], numbers[i + 1], numbers[i + 2]);
    curves.widths = read_widths(geom, curves, moment, counts->isConstant());
    return curves;
}

} // namespace vmlight::alembic
