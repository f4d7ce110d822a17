// SPDX-License-Identifier: Apache-2.0
/// PLY files.
#pragma once

#include <vmlight/mesh/import/importer.h>
#include <vmlight/mesh/import/ply_file.h>

#include <string>

namespace vmlight {

/// PLY: starts with "ply", in any case.
bool is_ply(const FileHead& head);

/// MeshFormat::read of PLY.
bool read_ply(MeshBuilder& dst, const ImportRequest& request, std::string& error);

/// Append the faces of a parsed file. Texture coordinates of corners go before those of vertices, and split vertices
/// where they differ. Vertices are rounded to float, unless they are of type `double` and far from the origin: see
/// is_far_from_origin(). Each texture is a material.
/// @param folder   of the file, where the paths of textures start
bool append_ply(MeshBuilder& dst, const ply::File& file, const std::string& folder, std::string& error);

} // namespace vmlight
