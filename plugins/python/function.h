// SPDX-License-Identifier: Apache-2.0
/// Functions of the module: declared once, for calls, docstrings and stubs.
#pragma once

#include "arguments.h"
#include "messages.h"
#include "work.h"

#include <pybind11/pybind11.h>

#include <string>
#include <utility>
#include <vector>

namespace vmlight::python {

/// What a function works on; by position or by name.
struct Operand
{
    const char* name;
    const char* type; ///< a type hint
    const char* help;
    const char* value = nullptr; ///< the default, a Python literal; nullptr: required
};

enum class FunctionKind
{
    function, ///< of the module; package/__init__.py wraps it
    method,
    static_method,
    constructor ///< by the name of its class
};

struct Function
{
    const char* name;
    FunctionKind kind;
    const char* summary;
    std::vector<Operand> operands;
    const char* returns; ///< a type hint; "" for a constructor
    const char* returns_what;
    std::vector<Argument> keywords {}; ///< all that are not operands
};

/// What a call was given: an object for each operand, None for one that is left out, and the rest.
struct Call
{
    std::vector<py::object> operands;
    py::dict keywords;
    WorkOptions work;

    bool has(const char* name) const { return keywords.contains(name); }
};

/// Sort the arguments of a call. Throws TypeError if an operand is missing or given twice, or a keyword is unknown; the
/// message names the nearest known one.
Call sort_arguments(const Function& function, const py::args& args, const py::kwargs& kwargs);

/// The docstring: the signature, as inspect.signature() reads it, the summary, and all arguments.
std::string docstring(const Function& function);

/// Remember a function for functions_table(), as "Class.method" or "function".
void add_to_table(const std::string& name, const Function& function);

/// All functions for the generator of the stubs: {name: {"operands", "keywords": (name, type, default), "returns"}}.
py::dict functions_table();

/// No keywords.
struct NoParams
{
    template <class Visit> void visit(Visit&&) { }
};

/// A function whose keywords are those of `Params`.
template <class Params> class Signature
{
public:
    /// @param left_out parameters that are no keywords here
    /// @param works    whether it takes the keywords of WorkOptions
    Signature(Function function, const std::vector<std::string>& left_out = {}, bool works = true)
        : m_function(std::move(function))
    {
        m_function.keywords = arguments_of(Params(), left_out);
        if (works)
            for (Argument& argument : work_arguments())
                m_function.keywords.push_back(std::move(argument));
        for (const Argument& argument : m_function.keywords)
            add_argument_name(argument.name);
    }

    const Function& function() const { return m_function; }

    /// The call's arguments, and its parameters.
    std::pair<Call, Params> read(const py::args& args, const py::kwargs& kwargs) const
    {
        Call call = sort_arguments(m_function, args, kwargs);
        Params params;
        set_params(params, call.keywords);
        return { std::move(call), std::move(params) };
    }

private:
    Function m_function;
};

} // namespace vmlight::python
