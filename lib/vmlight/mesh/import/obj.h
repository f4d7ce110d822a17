// SPDX-License-Identifier: Apache-2.0
/// OBJ files.
#pragma once

#include <vmlight/mesh/import/importer.h>
#include <vmlight/mesh/import/obj_file.h>

#include <string>
#include <vector>

namespace vmlight {

/// OBJ: the first line that is neither blank nor a comment starts with a keyword of OBJ.
bool is_obj(const FileHead& head);

/// MeshFormat::read of OBJ, and of the MTL files that it names.
bool read_obj(MeshBuilder& dst, const ImportRequest& request, std::string& error);

/// Append the faces of a parsed file, each under the node of its group. Vertices are rounded to float, unless those
/// that faces use are far from the origin: see is_far_from_origin().
/// @param materials    what is known of the materials; those that the file names beyond them are added by name
bool append_obj(MeshBuilder& dst, const obj::File& file, std::vector<Material> materials, std::string& error);

} // namespace vmlight
