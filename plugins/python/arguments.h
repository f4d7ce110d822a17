// SPDX-License-Identifier: Apache-2.0
/// Keyword arguments made from params structs: names, types, defaults, ranges and help are those of their visit(), and
/// values pass the parser that flags and recipe keys pass.
#pragma once

#include <vmlight/base/params.h>

#include <pybind11/pybind11.h>

#include <algorithm>
#include <string>
#include <vector>

namespace vmlight::python {

namespace py = pybind11;

/// A keyword argument, as signatures, docstrings and stubs show it.
struct Argument
{
    std::string name;
    std::string type; ///< a type hint, without quotes
    std::string value; ///< the default, a Python literal
    std::string allowed; ///< "1..1048576", or "" if the type says it all
    std::string help;
};

// The text that parse_value() takes for a Python value. Throws TypeError, which names the argument, for a value of
// another type; whether it is in range is left to parse_value().
std::string text_of(const char* name, py::handle value, const Range& allowed, int);
std::string text_of(const char* name, py::handle value, const Range& allowed, double);
std::string text_of(const char* name, py::handle value, const SizeRange& allowed, Size);
std::string text_of(const char* name, py::handle value, const Choices& allowed, const std::string&);
std::string text_of(const char* name, py::handle value, const ChoiceSet& allowed, const std::vector<std::string>&);
std::string text_of(const char* name, py::handle value, const Text& allowed, const std::string&);
std::string text_of(const char* name, py::handle value, const Path& allowed, const std::string&);
std::string text_of(const char* name, py::handle value, const Paths& allowed, const std::vector<std::string>&);
std::string text_of(const char* name, py::handle value, const Names& allowed, const std::vector<std::string>&);
std::string text_of(const char* name, py::handle value, const Numbers& allowed, const std::vector<double>&);
std::string text_of(const char* name, py::handle value, const Flag& allowed, bool);

// How an argument looks in Python: its type hint, and a value as a literal.
Argument describe(const Range& allowed, int value);
Argument describe(const Range& allowed, double value);
Argument describe(const SizeRange& allowed, Size value);
Argument describe(const Choices& allowed, const std::string& value);
Argument describe(const ChoiceSet& allowed, const std::vector<std::string>& value);
Argument describe(const Text& allowed, const std::string& value);
Argument describe(const Path& allowed, const std::string& value);
Argument describe(const Paths& allowed, const std::vector<std::string>& value);
Argument describe(const Names& allowed, const std::vector<std::string>& value);
Argument describe(const Numbers& allowed, const std::vector<double>& value);
Argument describe(const Flag& allowed, bool value);

/// Text as a Python literal, in quotes.
std::string literal(const std::string& text);

/// The words of a parameter with what they mean, a line each; "" unless it takes words.
std::string meanings(const std::vector<Choice>& choices);

/// A str as UTF-8. Throws TypeError, which names the argument, and ValueError for lone surrogates.
std::string str_text(const char* name, py::handle value);

/// The bytes of a path: str, bytes or os.PathLike, by os.fsencode(). Throws TypeError, which names the argument.
std::string path_text(const char* name, py::handle path);

/// Whether a value is a path, and so names a file.
bool is_path(py::handle value);

/// The arguments of a params struct, without those that are `left_out`.
template <class Params> std::vector<Argument> arguments_of(Params params, const std::vector<std::string>& left_out = {})
{
    std::vector<Argument> arguments;
    params.visit([&](const char* name, auto& value, const auto& allowed, const Help& help) {
        if (std::find(left_out.begin(), left_out.end(), name) != left_out.end())
            return;
        Argument& argument = arguments.emplace_back(describe(allowed, value));
        argument.name = name;
        argument.help = help.text + meanings(choices_of(allowed));
    });
    return arguments;
}

/// Set the parameters that `keywords` names; others of its names are passed over. Throws TypeError for a value of the
/// wrong type, and ValueError, with the library's own sentence, for one out of range.
template <class Params> void set_params(Params& params, const py::dict& keywords)
{
    params.visit([&](const char* name, auto& value, const auto& allowed, const char*) {
        if (!keywords.contains(name))
            return;
        std::string reason;
        if (!parse_value(value, text_of(name, keywords[name], allowed, value), allowed, reason))
            throw py::value_error(std::string(name) + ": " + reason);
    });
}

} // namespace vmlight::python
