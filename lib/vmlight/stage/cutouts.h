// SPDX-License-Identifier: Apache-2.0
/// The cut-outs of a mesh: what the files of its materials say of opacity.
#pragma once

#include <vmlight/base/file_stamp.h>
#include <vmlight/mesh/mesh.h>
#include <vmlight/trace/cutouts.h>

#include <functional>
#include <string>
#include <vector>

namespace vmlight {

/// How a mesh was read, and what will become of it.
struct CutoutSource
{
    /// The UV set of Mesh::uvs.
    int uv_set = 0;
    /// Those will be replaced, as unwrapping does.
    bool loses_uvs = false;
    /// Read the same triangles again with another UV set. False if they cannot be read.
    std::function<bool(Mesh& dst, int uv_set)> read_again;
};

/// Set `mesh.opacity` by the materials that its triangles have: where glTF says MASK or BLEND, where an MTL file has
/// `d` below 1 or `map_d`, and where other formats give an opacity. Alpha that is 1 everywhere, or reaches the cutoff
/// everywhere, is as none: then it is left nullptr, and what reads it does nothing. Only alpha is read of a texture.
///
/// @param files    nullptr, or appended to: the stamps of the textures
/// @returns false, with the reason in `error`, if a texture is missing or cannot be read, or does not fit in memory
bool read_cutouts(Mesh& mesh, const CutoutSource& source, std::vector<FileStamp>* files, std::string& error);

/// A line for the report of a bake, or "" without cut-outs.
std::string cutout_line(const CutoutCounts& counts);
/// What is odd about them, or "".
std::string cutout_warning(const CutoutCounts& counts);

} // namespace vmlight
