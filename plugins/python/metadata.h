// SPDX-License-Identifier: Apache-2.0
/// Metadata of images as Python's numbers, strings and tuples.
#pragma once

#include <OpenImageIO/imageio.h>

#include <pybind11/pybind11.h>

namespace vmlight::python {

namespace py = pybind11;

/// All metadata of an image. Values of other types than integers, floats and strings are strings.
py::dict metadata_of(const OIIO::ImageSpec& spec);

/// Add metadata: integers, floats, strings, and sequences of floats. Throws TypeError for other values.
void add_metadata(OIIO::ImageSpec& spec, const py::dict& metadata);

} // namespace vmlight::python
