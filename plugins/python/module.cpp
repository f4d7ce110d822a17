// SPDX-License-Identifier: Apache-2.0
/// The Python module: what `import vmlight` finds is in package/__init__.py.
#include "function.h"
#include "image.h"
#include "mesh_input.h"
#include "messages.h"
#include "stages.h"
#include "work.h"

#include <vmlight/version.h>

#include <OpenImageIO/imageio.h>
#include <OpenImageIO/sysutil.h>

#include <pybind11/pybind11.h>

PYBIND11_MODULE(_vmlight, m)
{
    using namespace vmlight::python;
    // Debian's OIIO 3 prints debug messages on stderr by default.
    if (OIIO::Sysutil::getenv("OPENIMAGEIO_DEBUG").empty())
        OIIO::attribute("debug", 0);
    py::options options;
    options.disable_function_signatures(); // docstrings begin with one
    m.attr("__version__") = VMLIGHT_VERSION_STRING;
    define_errors(m);
    stop_work_at_exit();
    define_image(m);
    define_mesh(m);
    define_bakes(m);
    define_filters(m);
    define_lightmaps(m);
    m.def("_functions", &functions_table, "_functions()\n--\n\nAll functions and their arguments, for the stubs.");
}
