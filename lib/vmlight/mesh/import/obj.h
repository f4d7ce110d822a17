// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vmlight/mesh/import/import.h>

#include <string>

namespace vmlight {

/// As inspect_mesh_file(), of the text of an OBJ file. Lines end in LF, CR or both; one that ends in a backslash goes
/// on in the next. How far the file lies is told by the vertices that faces use. Source: Wavefront, "Object Files
/// (.obj)", Advanced Visualizer Manual, appendix B1.
MeshFile inspect_obj(const std::string& text);

} // namespace vmlight
