// SPDX-License-Identifier: Apache-2.0
/// Errors and warnings of the library, as Python's.
#pragma once

#include <pybind11/pybind11.h>

#include <string>

namespace vmlight::python {

namespace py = pybind11;

/// A text of the library in the words of Python: it calls arguments by their flags, --max-distance.
std::string in_python(const std::string& text);
/// Let in_python() know an argument.
void add_argument_name(const std::string& name);

/// Throw vmlight.Error, in_python().
[[noreturn]] void throw_error(const std::string& error);

/// Warn by vmlight.Warning, in_python(). Throws if a filter of the user makes an error of it.
///
/// @param level    how many frames of Python up the place is that the warning names
void warn(const std::string& line, int level);

/// Add vmlight.Error and vmlight.Warning.
void define_errors(py::module_& m);

} // namespace vmlight::python
