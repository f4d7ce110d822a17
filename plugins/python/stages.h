// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <pybind11/pybind11.h>

namespace vmlight::python {

// Add the functions and classes of the module, each file its own.
void define_bakes(pybind11::module_& m);
void define_filters(pybind11::module_& m);
void define_lightmaps(pybind11::module_& m);

} // namespace vmlight::python
