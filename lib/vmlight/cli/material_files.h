// SPDX-License-Identifier: Apache-2.0
/// "<MATERIAL>" in the name of an output: one map for each material.
#pragma once

#include <string>
#include <vector>

namespace vmlight {

/// Does `path` contain "<MATERIAL>"?
bool has_material_pattern(const std::string& path);

/// A material's name as part of a file's name: ASCII letters, digits, '-', '_' and '.' are kept, and so is what is
/// beyond ASCII if the name is UTF-8; each other character, and a '.' in front, becomes '_'.
std::string material_file_name(const std::string& material);

/// `path` with each "<MATERIAL>" replaced by the material's file name.
std::string material_path(const std::string& path, const std::string& material);

/// Which two of `materials` would have the same file, or "".
std::string same_file_fault(const std::vector<std::string>& materials);

} // namespace vmlight
