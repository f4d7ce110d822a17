// SPDX-License-Identifier: Apache-2.0
#include "arguments.h"

#include <vmlight/base/format.h>
#include <vmlight/base/param_text.h>

#include <OpenImageIO/strutil.h>

#include <cmath>

namespace vmlight::python {
namespace {

[[noreturn]] void refuse(const char* name, const std::string& wanted, py::handle value)
{
    throw py::type_error(format("{}: must be {}, not {}", name, wanted, Py_TYPE(value.ptr())->tp_name));
}

// numpy's bool is none of Python's.
bool is_bool(py::handle value)
{
    return PyBool_Check(value.ptr()) || std::string(Py_TYPE(value.ptr())->tp_name).rfind("numpy.bool", 0) == 0;
}

bool is_int(py::handle value)
{
    return PyIndex_Check(value.ptr()) && !is_bool(value);
}

bool is_number(py::handle value)
{
    return !is_bool(value) && !PyUnicode_Check(value.ptr()) && PyNumber_Check(value.ptr())
        && !PyComplex_Check(value.ptr());
}

// Calls that fail leave Python's own exception.
py::object owned(PyObject* made)
{
    if (!made)
        throw py::error_already_set();
    return py::reinterpret_steal<py::object>(made);
}

std::string int_text(py::handle value)
{
    return py::cast<std::string>(py::str(owned(PyNumber_Index(value.ptr()))));
}

// repr() of a float reads back to the same float.
std::string float_text(py::handle value)
{
    return py::cast<std::string>(py::repr(owned(PyNumber_Float(value.ptr()))));
}

bool is_word(py::handle value, const Range& allowed)
{
    return allowed.word && PyUnicode_Check(value.ptr())
        && PyUnicode_CompareWithASCIIString(value.ptr(), allowed.word) == 0;
}

std::string or_word(const std::string& wanted, const Range& allowed)
{
    return allowed.word ? format("{} or {}", wanted, literal(allowed.word)) : wanted;
}

bool is_sequence(py::handle value)
{
    return !PyUnicode_Check(value.ptr()) && !PyBytes_Check(value.ptr()) && PySequence_Check(value.ptr())
        && !PyDict_Check(value.ptr());
}

// Numbers of a sequence, a matrix row by row.
void add_numbers(const char* name, py::handle value, const std::string& wanted, std::vector<std::string>& texts)
{
    for (py::handle item : py::reinterpret_borrow<py::object>(value)) {
        if (is_sequence(item))
            add_numbers(name, item, wanted, texts);
        else if (is_number(item))
            texts.push_back(float_text(item));
        else
            refuse(name, wanted, item);
    }
}

std::string lines(const char* name, py::handle value, const char* wanted, std::string (*text)(const char*, py::handle))
{
    std::vector<std::string> names;
    if (is_path(value)) {
        names.push_back(text(name, value));
    } else {
        if (!is_sequence(value))
            refuse(name, wanted, value);
        for (py::handle item : py::reinterpret_borrow<py::object>(value))
            names.push_back(text(name, item));
    }
    for (const std::string& line : names)
        if (line.find('\n') != std::string::npos || line.empty())
            throw py::value_error(
                format("{}: {} {}", name, literal(line),
                       line.empty() ? "is empty; leave it out" : "has a line break, which vmlight cannot pass on"));
    return OIIO::Strutil::join(names, "\n");
}

} // namespace

std::string str_text(const char* name, py::handle value)
{
    if (!PyUnicode_Check(value.ptr()))
        refuse(name, "str", value);
    Py_ssize_t size = 0;
    const char* const text = PyUnicode_AsUTF8AndSize(value.ptr(), &size);
    if (!text) // a lone surrogate
        throw py::error_already_set();
    return { text, size_t(size) };
}

bool is_path(py::handle value)
{
    return PyUnicode_Check(value.ptr()) || PyBytes_Check(value.ptr()) || py::hasattr(value, "__fspath__");
}

std::string path_text(const char* name, py::handle path)
{
    if (!is_path(path))
        refuse(name, "a path", path);
    const auto bytes = py::cast<std::string>(py::module_::import("os").attr("fsencode")(path));
    if (bytes.find('\0') != std::string::npos)
        throw py::value_error(std::string(name) + ": a name cannot contain a zero byte");
    return bytes;
}

std::string text_of(const char* name, py::handle value, const Range& allowed, int)
{
    if (is_word(value, allowed))
        return allowed.word;
    if (!is_int(value))
        refuse(name, or_word("int", allowed), value);
    return int_text(value);
}

std::string text_of(const char* name, py::handle value, const Range& allowed, double)
{
    if (is_word(value, allowed))
        return allowed.word;
    if (!is_number(value))
        refuse(name, or_word("float", allowed), value);
    // What Python has a number for: max_distance=math.inf.
    const std::string text = float_text(value);
    const double number = py::cast<double>(owned(PyNumber_Float(value.ptr())));
    return allowed.word && std::isinf(number) && number == allowed.word_value ? allowed.word : text;
}

std::string text_of(const char* name, py::handle value, const SizeRange&, Size)
{
    if (PyUnicode_Check(value.ptr()))
        return str_text(name, value);
    if (is_int(value))
        return int_text(value);
    std::vector<std::string> sides;
    if (is_sequence(value))
        for (py::handle side : py::reinterpret_borrow<py::object>(value)) {
            if (!is_int(side))
                refuse(name, "int, or (width, height)", side);
            sides.push_back(int_text(side));
        }
    if (sides.size() != 2)
        refuse(name, "int, or (width, height)", value);
    return sides[0] + "x" + sides[1];
}

std::string text_of(const char* name, py::handle value, const Choices&, const std::string&)
{
    return str_text(name, value);
}

std::string text_of(const char* name, py::handle value, const ChoiceSet&, const std::vector<std::string>&)
{
    if (PyUnicode_Check(value.ptr()))
        return str_text(name, value);
    if (!is_sequence(value))
        refuse(name, "words", value);
    std::vector<std::string> texts;
    for (py::handle word : py::reinterpret_borrow<py::object>(value))
        texts.push_back(str_text(name, word));
    return OIIO::Strutil::join(texts, ",");
}

std::string text_of(const char* name, py::handle value, const Text&, const std::string&)
{
    return str_text(name, value);
}

std::string text_of(const char* name, py::handle value, const Path&, const std::string&)
{
    return path_text(name, value);
}

std::string text_of(const char* name, py::handle value, const Paths&, const std::vector<std::string>&)
{
    return lines(name, value, "paths", path_text);
}

std::string text_of(const char* name, py::handle value, const Names&, const std::vector<std::string>&)
{
    return lines(name, value, "names", str_text);
}

std::string text_of(const char* name, py::handle value, const Numbers& allowed, const std::vector<double>&)
{
    const std::string wanted = format("{} floats", allowed.count);
    if (!is_sequence(value))
        refuse(name, wanted, value);
    std::vector<std::string> texts;
    add_numbers(name, value, wanted, texts);
    return OIIO::Strutil::join(texts, ", ");
}

std::string text_of(const char* name, py::handle value, const Flag&, bool)
{
    if (!is_bool(value))
        refuse(name, "bool", value);
    return PyObject_IsTrue(value.ptr()) ? "true" : "false";
}

} // namespace vmlight::python
