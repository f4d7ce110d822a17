// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

namespace vmlight {

/// Why the mesh importer must not be given this file, or "". It looks for what is known to crash or to hang assimp 5.2:
/// a PLY header that has no end, or that promises more elements than the file has bytes.
std::string mesh_file_fault(const std::string& path);

} // namespace vmlight
