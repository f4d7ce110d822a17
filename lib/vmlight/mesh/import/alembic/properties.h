// SPDX-License-Identifier: Apache-2.0
/// The properties of an object, and their samples at one moment. The library's own schemas (AbcGeom) trust the sizes
/// that a file declares; these functions check them, and read nothing of more bytes than the file has.
#pragma once

#include <Alembic/AbcCoreAbstract/All.h>

#include <cstdint>
#include <limits>
#include <optional>
#include <string>
#include <vector>

namespace vmlight::alembic {

namespace AbcA = ::Alembic::AbcCoreAbstract;

/// Two samples, and the weight of the second; twice the same if there is nothing between them.
struct SamplePair
{
    int64_t first = 0, second = 0;
    double weight = 0;
};

/// The time that a file is read at, and that of what it has seen.
class Moment
{
public:
    /// @param seconds      nothing for the first sample of everything
    explicit Moment(std::optional<double> seconds)
        : m_seconds(seconds)
    {
    }

    /// The samples around the moment of a property with `count` of them. The first or last one beyond the ends. Of one
    /// closer than a hundredth of the step from the other, that one alone: frame rates are rounded (23.976).
    SamplePair samples(const AbcA::TimeSampling& times, size_t count, bool is_constant);

    /// The first and last time, in seconds, of all properties that change; first > last if none does.
    double first() const { return m_first; }
    double last() const { return m_last; }

private:
    std::optional<double> m_seconds;
    double m_first = std::numeric_limits<double>::infinity(), m_last = -std::numeric_limits<double>::infinity();
};

/// The property of this name, or nullptr if there is none, it is of another kind, or it has no samples. `parent` may be
/// nullptr.
AbcA::CompoundPropertyReaderPtr find_compound(const AbcA::CompoundPropertyReaderPtr& parent, const std::string& name);
AbcA::ArrayPropertyReaderPtr find_array(const AbcA::CompoundPropertyReaderPtr& parent, const std::string& name);
AbcA::ScalarPropertyReaderPtr find_scalar(const AbcA::CompoundPropertyReaderPtr& parent, const std::string& name);

/// The samples of `property` at `moment`.
template <class Reader> SamplePair samples_at(Reader& property, Moment& moment)
{
    return moment.samples(*property.getTimeSampling(), property.getNumSamples(), property.isConstant());
}

/// The numbers of one sample: float, double, int32_t, uint32_t, int8_t or uint8_t. Throws Error if the property holds
/// another type, or elements of other than `extent` numbers.
template <class Number>
std::vector<Number> read_array(AbcA::ArrayPropertyReader& property, int64_t sample, int extent = 1);
/// The numbers of one sample of a property with one element, of any extent. Flags are uint8_t.
template <class Number> std::vector<Number> read_scalar(AbcA::ScalarPropertyReader& property, int64_t sample);

/// Does a property hold elements of `extent` floats?
bool holds_floats(AbcA::ArrayPropertyReader& property, int extent);

/// A * (1 - weight) + B * weight of each; A if they differ in number.
template <class Number> std::vector<Number> blend(std::vector<Number> a, const std::vector<Number>& b, double weight)
{
    for (size_t i = 0; a.size() == b.size() && i < a.size(); ++i)
        a[i] = Number(double(a[i]) * (1 - weight) + double(b[i]) * weight);
    return a;
}

} // namespace vmlight::alembic
