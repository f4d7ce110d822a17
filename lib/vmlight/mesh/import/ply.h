// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vmlight/mesh/import/import.h>

#include <string>

namespace vmlight {

/// As inspect_mesh_file(), of the bytes of a PLY file. Every element is walked over, in all three formats; in an ascii
/// one each takes a line, as the importer has it.
/// Source: G. Turk, "The PLY Polygon File Format", 1994.
MeshFile inspect_ply(const std::string& bytes);

} // namespace vmlight
