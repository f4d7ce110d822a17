// SPDX-License-Identifier: Apache-2.0
/// Recipes made of arguments, checked as flags are.
#pragma once

#include "function.h"
#include "messages.h"
#include "work.h"

#include <vmlight/stage/recipe/chain.h>
#include <vmlight/stage/recipe/recipe.h>
#include <vmlight/stage/recipe/unused_flags.h>

#include <pybind11/pybind11.h>

#include <string>

namespace vmlight::python {

/// Throw ValueError if an argument of the call cannot change the result.
template <class Recipe> void check_unused(const Recipe& recipe, const Call& call)
{
    for (const auto& [key, value] : call.keywords) {
        const std::string name = py::cast<std::string>(key), reason = unused_reason(recipe, name);
        if (!reason.empty())
            throw py::value_error(name + ": " + in_python(reason));
    }
}

/// The same, and if the arguments contradict each other. Takes `udim` as given if it is.
template <class Recipe> void check_recipe(Recipe& recipe, const Call& call)
{
    recipe.udim_given = call.has("udim");
    if (const std::string fault = recipe_fault(recipe, {}); !fault.empty())
        throw py::value_error(in_python(fault));
    check_unused(recipe, call);
}

} // namespace vmlight::python
