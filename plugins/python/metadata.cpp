// SPDX-License-Identifier: Apache-2.0
#include "metadata.h"

#include <vmlight/base/format.h>

#include <string>
#include <vector>

namespace vmlight::python {
namespace {

template <class T> py::object numbers(const OIIO::ParamValue& value)
{
    const T* const first = static_cast<const T*>(value.data());
    const size_t count = value.type().numelements() * size_t(value.type().aggregate);
    if (count == 1)
        return py::cast(*first);
    py::tuple all(count);
    for (size_t i = 0; i < count; ++i)
        all[i] = py::cast(first[i]);
    return std::move(all);
}

// Text from files need not be UTF-8.
py::object text(const std::string& bytes)
{
    return py::reinterpret_steal<py::object>(
        PyUnicode_DecodeUTF8(bytes.data(), Py_ssize_t(bytes.size()), "surrogateescape"));
}

} // namespace

py::dict metadata_of(const OIIO::ImageSpec& spec)
{
    py::dict dst;
    for (const OIIO::ParamValue& value : spec.extra_attribs) {
        const auto type = value.type().basetype;
        dst[text(value.name().string())] = type == OIIO::TypeDesc::INT ? numbers<int>(value)
            : type == OIIO::TypeDesc::FLOAT                            ? numbers<float>(value)
            : type == OIIO::TypeDesc::DOUBLE                           ? numbers<double>(value)
                                                                       : text(value.get_string());
    }
    return dst;
}

void add_metadata(OIIO::ImageSpec& spec, const py::dict& metadata)
{
    for (const auto& [key, value] : metadata) {
        if (!py::isinstance<py::str>(key))
            throw py::type_error("metadata: names must be str");
        const std::string name = py::cast<std::string>(key);
        if (py::isinstance<py::str>(value)) {
            spec.attribute(name, py::cast<std::string>(value));
        } else if (py::isinstance<py::int_>(value)) {
            const long number = PyLong_AsLong(value.ptr());
            if (PyErr_Occurred() || number != int(number))
                throw py::value_error("metadata: " + name + ": more than an integer of 32 bits holds");
            spec.attribute(name, int(number));
        } else if (py::isinstance<py::float_>(value)) {
            spec.attribute(name, py::cast<float>(value));
        } else if (PySequence_Check(value.ptr())) {
            std::vector<float> numbers;
            for (py::handle number : py::reinterpret_borrow<py::object>(value))
                numbers.push_back(py::cast<float>(number));
            spec.attribute(name, OIIO::TypeDesc(OIIO::TypeDesc::FLOAT, int(numbers.size())), numbers.data());
        } else {
            throw py::type_error(
                format("metadata: {}: must be a number, str or floats, not {}", name, Py_TYPE(value.ptr())->tp_name));
        }
    }
}

} // namespace vmlight::python
