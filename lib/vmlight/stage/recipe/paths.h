// SPDX-License-Identifier: Apache-2.0
/// Paths in recipes: relative ones start at the folder of the recipe, and in a ?query at the current folder.
#pragma once

#include <string>

namespace vmlight {

/// The stage whose recipes have the extension of `path`, which has no query; or "".
std::string stage_of_extension(const std::string& path);

/// Where the query of an image's or recipe's name starts, or npos: at a '?' behind the extension of a recipe. If there
/// are several, at the first that leaves the name of a file, since folders and files may have a '?' in their names.
size_t query_mark(const std::string& name);

/// The path that a recipe in `folder` means by `path`. Absolute paths and names such as "ocio://default" are kept.
std::string in_folder(const std::string& folder, const std::string& path);

/// What a recipe in `folder` must say to mean `path`, which starts at the current folder, as do the paths in its query:
/// those are written in full. "" and "." are the current folder.
std::string seen_from(const std::string& folder, const std::string& path);

} // namespace vmlight
