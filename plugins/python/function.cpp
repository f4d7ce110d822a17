// SPDX-License-Identifier: Apache-2.0
#include "function.h"

#include <vmlight/base/format.h>

#include <OpenImageIO/strutil.h>

#include <map>

namespace vmlight::python {
namespace {

std::vector<std::pair<std::string, Function>>& table()
{
    static std::vector<std::pair<std::string, Function>> functions;
    return functions;
}

std::string signature(const Function& function)
{
    std::vector<std::string> parts;
    const bool is_constructor = function.kind == FunctionKind::constructor;
    if (function.kind == FunctionKind::method || is_constructor)
        parts.push_back("self");
    for (const Operand& operand : function.operands)
        parts.push_back(operand.value ? format("{}={}", operand.name, operand.value) : operand.name);
    if (!function.keywords.empty())
        parts.push_back("*");
    for (const Argument& argument : function.keywords)
        parts.push_back(format("{}={}", argument.name, argument.value));
    return format("{}({})", is_constructor ? "__init__" : function.name, OIIO::Strutil::join(parts, ", "));
}

// Lines of their own, wrapped.
std::string indented(const std::string& text)
{
    std::vector<std::string> lines;
    for (const std::string& line : OIIO::Strutil::splits(text, "\n"))
        lines.push_back("        " + OIIO::Strutil::wordwrap(line, 88, 8));
    return OIIO::Strutil::join(lines, "\n") + "\n";
}

} // namespace

Call sort_arguments(const Function& function, const py::args& args, const py::kwargs& kwargs)
{
    Call call;
    if (args.size() > function.operands.size())
        throw py::type_error(format("{}() takes {} positional argument{}, but {} were given; name the others",
                                    function.name, function.operands.size(), function.operands.size() == 1 ? "" : "s",
                                    args.size()));
    std::vector<std::string> names;
    py::dict rest(kwargs);
    for (size_t i = 0; i < function.operands.size(); ++i) {
        const Operand& operand = function.operands[i];
        names.push_back(operand.name);
        const bool is_named = kwargs.contains(operand.name);
        if (i < args.size() && is_named)
            throw py::type_error(format("{}(): {} is given twice", function.name, operand.name));
        if (i >= args.size() && !is_named && !operand.value)
            throw py::type_error(format("{}(): {} is missing", function.name, operand.name));
        call.operands.push_back(i < args.size() ? py::object(args[i])
                                    : is_named  ? py::object(kwargs[operand.name])
                                                : py::none());
    }
    for (const Argument& argument : function.keywords)
        names.push_back(argument.name);
    for (const auto& [key, value] : kwargs) {
        const std::string name = py::cast<std::string>(key);
        const auto known = std::find(names.begin(), names.end(), name);
        if (known == names.end()) {
            const std::string near = nearest_name(name, names);
            throw py::type_error(format("{}() has no argument \"{}\"{}", function.name, name,
                                        near.empty() ? "" : format("; did you mean \"{}\"?", near)));
        }
        if (known - names.begin() >= std::ptrdiff_t(function.operands.size()))
            call.keywords[key] = value;
    }
    call.work = work_options(call.keywords);
    call.work.warning_level = function.kind == FunctionKind::function ? 2 : 1;
    return call;
}

std::string docstring(const Function& function)
{
    std::string text = signature(function) + "\n--\n\n" + function.summary + "\n\nArguments:\n";
    for (const Operand& operand : function.operands)
        text += format("    {}: {}{}\n{}", operand.name, operand.type,
                       operand.value ? format(", default {}", operand.value) : "", indented(operand.help));
    for (const Argument& argument : function.keywords) {
        const bool is_word = OIIO::Strutil::starts_with(argument.type, "Literal");
        text += format("    {}: {}, default {}\n", argument.name,
                       !argument.allowed.empty() ? argument.allowed
                           : is_word             ? "one of the words below"
                                                 : argument.type,
                       argument.value);
        text += indented(in_python(argument.help));
    }
    if (*function.returns)
        text += format("\nReturns: {}\n", function.returns) + indented(function.returns_what);
    return text;
}

void add_to_table(const std::string& name, const Function& function)
{
    table().emplace_back(name, function);
}

py::dict functions_table()
{
    py::dict dst;
    for (const auto& [name, function] : table()) {
        py::list operands, keywords;
        for (const Operand& operand : function.operands)
            operands.append(py::make_tuple(operand.name, operand.type, operand.value));
        for (const Argument& argument : function.keywords)
            keywords.append(py::make_tuple(argument.name, argument.type, argument.value));
        py::dict entry;
        entry["operands"] = operands;
        entry["keywords"] = keywords;
        entry["returns"] = function.returns;
        entry["summary"] = function.summary;
        dst[py::str(name)] = entry;
    }
    return dst;
}

} // namespace vmlight::python
