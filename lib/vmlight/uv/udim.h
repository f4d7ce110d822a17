// SPDX-License-Identifier: Apache-2.0
/// UDIM: texture tiles numbered 1001 + u + 10 v, ten across; tile 1001 is [0,1] x [0,1].
#pragma once

#include <vmlight/base/export.h>
#include <vmlight/mesh/mesh.h>

#include <Imath/ImathVec.h>

#include <string>
#include <vector>

namespace vmlight {

/// The first and last UDIM tile.
constexpr int kFirstUdim = 1001, kLastUdim = 9999;
/// An island may cross the border of a tile by this much, in tiles, and still end on it: the precision of float uvs
/// up to 10.
constexpr double kUdimBorder = 1e-6;

/// The lower left corner of a tile in uv: (0, 0) for 1001, (1, 0) for 1002, (0, 1) for 1011.
inline Imath::V2f udim_corner(int udim)
{
    return Imath::V2f(float((udim - kFirstUdim) % 10), float((udim - kFirstUdim) / 10));
}

/// Parse a list such as "1001-1003,1011" into ascending tile numbers without duplicates. False, with the reason in
/// `error`, if it is not a list or a number is not a UDIM tile.
VMLIGHT_API bool parse_udims(std::vector<int>& dst, const std::string& text, std::string& error);

/// The UDIM tile in a file name, between the last two dots ("hero.1011.lightmap"), or 0 if there is none. Links are not
/// followed.
VMLIGHT_API int udim_from_name(const std::string& path);

/// Does `path` contain "<UDIM>"?
VMLIGHT_API bool has_udim_pattern(const std::string& path);
/// `path` with each "<UDIM>" replaced by the tile's number.
VMLIGHT_API std::string udim_path(const std::string& path, int udim);
/// The tiles whose files exist, ascending. "<UDIM>" must be in the file name, not in a folder's name.
VMLIGHT_API std::vector<int> existing_udims(const std::string& path);

/// The tiles that `mesh` uses, ascending: those that the uv bounds of a triangle overlap by more than kUdimBorder, so
/// that an island that ends on a border is in one tile only. Triangles whose uvs are missing, not finite or outside the
/// ten columns of tiles are ignored.
VMLIGHT_API std::vector<int> mesh_udims(const Mesh& mesh);

} // namespace vmlight
