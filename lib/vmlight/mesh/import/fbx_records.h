// SPDX-License-Identifier: Apache-2.0
/// The records of FBX files, text and binary.
#pragma once

#include <functional>
#include <string>
#include <vector>

namespace vmlight {

/// How a binary FBX starts, as far as assimp compares.
constexpr char kFbxMagic[] = "Kaydara FBX Binary";

/// Called for each record directly within a top-level record `list`.
/// @param properties   the first four at most: strings without quotes, numbers in decimal; of a binary file only those
///                     before the first that is neither a string nor a 64-bit integer, read as unsigned
using FbxVisitor = std::function<void(const std::string& list, const std::string& record,
                                      const std::vector<std::string>& properties)>;

/// Visit the records of an FBX file in file order, tokenized as assimp 5.2 does.
///
/// Returns why assimp must not read the file, or "": brackets nested more than 1000 deep, or a record of a binary file
/// that extends past the one that contains it. Other errors are not detected: what looks like a record is visited.
/// Sources: assimp 5.2, FBXTokenizer.cpp and FBXBinaryTokenizer.cpp; Blender Foundation, "FBX binary file format
/// specification" (2013).
std::string read_fbx_records(const std::string& bytes, const FbxVisitor& visit);

} // namespace vmlight
