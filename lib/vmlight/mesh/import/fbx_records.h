// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <string>
#include <vector>

namespace vmlight {

/// What is called for each record within a top-level record `list` of an FBX.
/// @param properties   the first four at most: strings without their quotes, numbers in decimal; of a binary file as
///                     many as are strings and 64-bit integers, taken as unsigned
using FbxVisitor = std::function<void(const std::string& list, const std::string& record,
                                      const std::vector<std::string>& properties)>;

/// Visit the records of an FBX file, text or binary, in its order, cut from each other as assimp 5.2 does.
///
/// Returns why the importer must not be given the file, or "": brackets more than 1000 deep, a record of a binary file
/// that does not fit into what holds it. Of what else is wrong it sees nothing, and visits what it takes for records.
/// Sources: assimp 5.2, FBXTokenizer.cpp and FBXBinaryTokenizer.cpp; Blender Foundation, "FBX binary file format
/// specification" (2013).
std::string read_fbx_records(const std::string& bytes, const FbxVisitor& visit);

} // namespace vmlight
