// SPDX-License-Identifier: Apache-2.0
/// "<MATERIAL>" or "<INSTANCE>" in the name of an output: one map for each material or instance of a mesh.
#pragma once

#include <vmlight/stage/make_stage.h>
#include <vmlight/stage/map_parts.h>

#include <string>
#include <vector>

namespace vmlight {

/// A pattern that stands for the name of a part of a mesh.
struct MeshPartPattern
{
    const char* text; ///< "<MATERIAL>"
    const char *noun, *nouns; ///< what it stands for
    const char* flag; ///< that chooses one of them
    std::string PartFiles::*of_parts; ///< which one the parts of a map are of
    std::vector<std::string> MeshSelection::*selection; ///< where a recipe names it
    bool (*find)(std::vector<std::string>& dst, const VismapRecipe& recipe, const MakeOptions& options,
                 std::string& error); ///< all that a recipe bakes
};

/// All of them.
const std::vector<MeshPartPattern>& mesh_part_patterns();

/// Their texts, as a list in words: "<MATERIAL> and <INSTANCE>".
std::string mesh_part_pattern_list();

/// The pattern of `path`, the first in that order; nullptr without.
const MeshPartPattern* mesh_part_pattern(const std::string& path);

/// A part's name as part of a file's name: ASCII letters, digits, '-', '_' and '.' are kept, and so is what is beyond
/// ASCII if the name is UTF-8; each other character, and a '.' in front, becomes '_'.
std::string mesh_part_file_name(const std::string& name);

/// `path` with each `pattern` replaced by the part's file name.
std::string mesh_part_path(const std::string& path, const MeshPartPattern& pattern, const std::string& name);

/// Which two of the parts would have the same file, or "".
std::string same_file_fault(const MeshPartPattern& pattern, const std::vector<std::string>& names);

} // namespace vmlight
