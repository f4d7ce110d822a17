// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vmlight/mesh/import/import.h>

#include <string>

namespace vmlight {

/// Why the importer must not be given an FBX file of these bytes, text or binary, or "": what read_fbx_records() says;
/// a Model under itself; Models more than 5000 deep, or, once each is put under all that its connections name, as the
/// importer does, more than the connections and 50000. Connections of other things (skins, clusters, geometries) may
/// form rings and are not looked at; what else is wrong is the importer's to refuse. Its recursion goes as deep: see
/// on_deep_stack(). Source: assimp 5.2, FBXDocument.cpp and FBXConverter.cpp.
std::string fbx_fault(const std::string& bytes);

/// The file with its fbx_fault(), if the importer may take it for FBX, which it does by its name or by "fbx", of any
/// case, in its first 200 bytes; else one without a fault.
MeshFile inspect_fbx(const std::string& path);

} // namespace vmlight
