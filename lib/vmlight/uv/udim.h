// SPDX-License-Identifier: Apache-2.0
/// UDIM: texture tiles numbered 1001 + u + 10 v, ten across; tile 1001 is [0,1] x [0,1].
#pragma once

#include <vmlight/base/export.h>
#include <vmlight/mesh/mesh.h>

#include <Imath/ImathVec.h>

#include <string>
#include <vector>

namespace vmlight {

/// The first and last tile there can be.
constexpr int kFirstUdim = 1001, kLastUdim = 9999;
/// How far, in tiles, an island may reach over a border and still end on it: floats of uvs up to 10 are good to that.
constexpr double kUdimBorder = 1e-6;

/// The lower left corner of a tile in uv: (0, 0) for 1001, (1, 0) for 1002, (0, 1) for 1011.
inline Imath::V2f udim_corner(int udim)
{
    return Imath::V2f(float((udim - kFirstUdim) % 10), float((udim - kFirstUdim) / 10));
}

/// "1001-1003,1011" in ascending order, each tile once. False, with the reason in `error`, if it is not such a list or
/// a number is no tile.
VMLIGHT_API bool parse_udims(std::vector<int>& dst, const std::string& text, std::string& error);

/// The tile that a file's name says it is for: the last part of its name before the extension, if there is one before
/// it and it is a tile's number ("hero.1011.lightmap"); else 0. By the name alone: a link is not followed.
VMLIGHT_API int udim_of_name(const std::string& path);

/// Does `path` hold "<UDIM>"?
VMLIGHT_API bool has_udim(const std::string& path);
/// `path` with each "<UDIM>" replaced by the tile's number.
VMLIGHT_API std::string udim_path(const std::string& path, int udim);
/// The tiles for which a file of that name exists, ascending. "<UDIM>" must be in the file's name, not in its folder's.
VMLIGHT_API std::vector<int> existing_udims(const std::string& path);

/// The tiles that triangles of `mesh` reach into, ascending: those which their uv bounds overlap by more than
/// kUdimBorder, so that an island that ends on a tile's border is in one tile only. Triangles whose uvs are
/// missing, not finite or outside of the ten columns of tiles count nowhere.
VMLIGHT_API std::vector<int> mesh_udims(const Mesh& mesh);

} // namespace vmlight
