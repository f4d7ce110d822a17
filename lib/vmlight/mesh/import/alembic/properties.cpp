// SPDX-License-Identifier: Apache-2.0
#include <vmlight/mesh/import/alembic/properties.h>

#include <vmlight/base/format.h>
#include <vmlight/mesh/import/alembic/error.h>

#include <algorithm>

namespace vmlight::alembic {
namespace {

namespace Util = ::Alembic::Util;

template <class Number> Util::PlainOldDataType type_of();
template <> Util::PlainOldDataType type_of<float>()
{
    return Util::kFloat32POD;
}
template <> Util::PlainOldDataType type_of<double>()
{
    return Util::kFloat64POD;
}
template <> Util::PlainOldDataType type_of<int32_t>()
{
    return Util::kInt32POD;
}
template <> Util::PlainOldDataType type_of<uint32_t>()
{
    return Util::kUint32POD;
}
template <> Util::PlainOldDataType type_of<int8_t>()
{
    return Util::kInt8POD;
}
template <> Util::PlainOldDataType type_of<uint8_t>()
{
    return Util::kUint8POD;
}

std::string place(AbcA::BasePropertyReader& property)
{
    return format("\"{}\" of \"{}\"", property.getName(), property.getObject()->getFullName());
}

template <class Number> void check_type(AbcA::BasePropertyReader& property)
{
    const Util::PlainOldDataType type = property.getDataType().getPod();
    const bool is_flag = type == Util::kBooleanPOD && type_of<Number>() == Util::kUint8POD; // a byte as well
    if (type != type_of<Number>() && !is_flag)
        throw Error(
            format("{} holds {}, not {}", place(property), Util::PODName(type), Util::PODName(type_of<Number>())));
}

const AbcA::PropertyHeader* find_header(const AbcA::CompoundPropertyReaderPtr& parent, const std::string& name)
{
    return parent ? parent->getPropertyHeader(name) : nullptr;
}

} // namespace

SamplePair Moment::samples(const AbcA::TimeSampling& times, size_t count, bool is_constant)
{
    if (is_constant || count < 2)
        return {};
    int64_t low = 0, high = int64_t(count) - 1;
    const double first = times.getSampleTime(low), last = times.getSampleTime(high);
    m_first = std::min(m_first, first);
    m_last = std::max(m_last, last);
    if (!m_seconds || !(*m_seconds > first))
        return {};
    if (!(*m_seconds < last))
        return { high, high, 0 };
    while (high - low > 1) {
        const int64_t middle = low + (high - low) / 2;
        (times.getSampleTime(middle) <= *m_seconds ? low : high) = middle;
    }
    const double from = times.getSampleTime(low);
    const double weight = (*m_seconds - from) / (times.getSampleTime(high) - from);
    constexpr double kSame = 0.01;
    if (!(weight > kSame))
        return { low, low, 0 };
    if (weight > 1 - kSame)
        return { high, high, 0 };
    return { low, high, weight };
}

AbcA::CompoundPropertyReaderPtr find_compound(const AbcA::CompoundPropertyReaderPtr& parent, const std::string& name)
{
    const AbcA::PropertyHeader* header = find_header(parent, name);
    return header && header->isCompound() ? parent->getCompoundProperty(name) : nullptr;
}

AbcA::ArrayPropertyReaderPtr find_array(const AbcA::CompoundPropertyReaderPtr& parent, const std::string& name)
{
    const AbcA::PropertyHeader* header = find_header(parent, name);
    const auto array = header && header->isArray() ? parent->getArrayProperty(name) : nullptr;
    return array && array->getNumSamples() > 0 ? array : nullptr;
}

AbcA::ScalarPropertyReaderPtr find_scalar(const AbcA::CompoundPropertyReaderPtr& parent, const std::string& name)
{
    const AbcA::PropertyHeader* header = find_header(parent, name);
    const auto scalar = header && header->isScalar() ? parent->getScalarProperty(name) : nullptr;
    return scalar && scalar->getNumSamples() > 0 ? scalar : nullptr;
}

template <class Number> std::vector<Number> read_array(AbcA::ArrayPropertyReader& property, int64_t sample, int extent)
{
    check_type<Number>(property);
    const int held = property.getDataType().getExtent();
    AbcA::ArraySampleKey key;
    if (held != extent || !property.getKey(sample, key) || key.numBytes % (sizeof(Number) * size_t(extent)) != 0)
        throw Error(
            format("{} is damaged: elements of {} numbers, not {}, or a part of one", place(property), held, extent));
    // Its dimensions may promise less than there is: the library would write past the end.
    std::vector<Number> numbers(key.numBytes / sizeof(Number));
    if (!numbers.empty())
        property.getAs(sample, numbers.data(), type_of<Number>());
    return numbers;
}

template <class Number> std::vector<Number> read_scalar(AbcA::ScalarPropertyReader& property, int64_t sample)
{
    check_type<Number>(property);
    std::vector<Number> numbers(property.getDataType().getExtent());
    if (!numbers.empty())
        property.getSample(sample, numbers.data()); // throws if the file has other than that
    return numbers;
}

bool holds_floats(AbcA::ArrayPropertyReader& property, int extent)
{
    return property.getDataType().getPod() == Util::kFloat32POD && property.getDataType().getExtent() == extent;
}

template std::vector<float> read_array(AbcA::ArrayPropertyReader&, int64_t, int);
template std::vector<double> read_array(AbcA::ArrayPropertyReader&, int64_t, int);
template std::vector<int32_t> read_array(AbcA::ArrayPropertyReader&, int64_t, int);
template std::vector<uint32_t> read_array(AbcA::ArrayPropertyReader&, int64_t, int);
template std::vector<double> read_scalar(AbcA::ScalarPropertyReader&, int64_t);
template std::vector<int8_t> read_scalar(AbcA::ScalarPropertyReader&, int64_t);
template std::vector<uint8_t> read_scalar(AbcA::ScalarPropertyReader&, int64_t);

} // namespace vmlight::alembic
