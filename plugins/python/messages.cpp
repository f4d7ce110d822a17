// SPDX-License-Identifier: Apache-2.0
#include "messages.h"

#include <vmlight/base/text_format.h>

#include <OpenImageIO/strutil.h>

#include <cctype>
#include <cstdint>
#include <set>
#include <vector>

namespace vmlight::python {
namespace {

// Names of files need not be UTF-8, Python's texts must be.
std::string printable_text(const std::string& text)
{
    std::vector<std::string> lines;
    for (const std::string& line : OIIO::Strutil::splits(text, "\n"))
        lines.push_back(printable_line(line));
    return OIIO::Strutil::join(lines, "\n");
}

std::set<std::string>& argument_names()
{
    static std::set<std::string> names;
    return names;
}

py::handle s_error, s_warning; // live as long as the process

} // namespace

void add_argument_name(const std::string& name)
{
    argument_names().insert(name);
}

std::string in_python(const std::string& given)
{
    const std::string text = printable_text(given);
    std::string dst;
    bool is_quoted = false;
    for (size_t i = 0; i < text.size();) {
        is_quoted ^= text[i] == '"';
        std::string name;
        size_t end = i + 2;
        if (!is_quoted && (i == 0 || text[i - 1] == ' ') && text.compare(i, 2, "--") == 0)
            for (; end < text.size() && (std::islower(uint8_t(text[end])) || text[end] == '-'); ++end)
                name += text[end] == '-' ? '_' : text[end];
        if (argument_names().count(name)) {
            dst += name;
            i = end;
        } else {
            dst += text[i++];
        }
    }
    return dst;
}

void throw_error(const std::string& error)
{
    PyErr_SetString(s_error.ptr(), in_python(error).c_str());
    throw py::error_already_set();
}

void warn(const std::string& line, int level)
{
    if (PyErr_WarnEx(s_warning.ptr(), in_python(line).c_str(), level) != 0) // a filter makes errors of warnings
        throw py::error_already_set();
}

void define_errors(py::module_& m)
{
    const auto define = [&](const char* name, const char* help, PyObject* base) {
        const std::string full = std::string("vmlight.") + name;
        PyObject* type = PyErr_NewExceptionWithDoc(full.c_str(), help, base, nullptr);
        if (!type)
            throw py::error_already_set();
        m.attr(name) = py::reinterpret_borrow<py::object>(type);
        return py::handle(type);
    };
    s_error
        = define("Error", "The work failed: an input cannot be used, or memory does not suffice.", PyExc_RuntimeError);
    s_warning = define("Warning", "What a user should know of an input or a result.", PyExc_UserWarning);
}

} // namespace vmlight::python
