// SPDX-License-Identifier: Apache-2.0
/// The vertices and faces of a PLY file.
#pragma once

#include <Imath/ImathVec.h>

#include <cstdint>
#include <string>
#include <vector>

namespace vmlight::ply {

struct File
{
    std::vector<Imath::V3f> positions; ///< see TextNumber::rounded
    std::vector<Imath::V3d> exact_positions; ///< empty unless a coordinate is of type `double`
    std::vector<Imath::V3f> normals; ///< of vertices; empty if there are none
    std::vector<Imath::V2f> uvs; ///< of vertices; empty if there are none

    std::vector<uint32_t> ends; ///< for each face, the corner behind its last; its first is the last face's end
    std::vector<uint32_t> corners; ///< vertices
    std::vector<Imath::V2f> corner_uvs; ///< NaN for none; empty if no face has any
    std::vector<int32_t> face_textures; ///< `texnumber` of each face, -1 for none; empty if no face has any
    std::vector<std::string> textures; ///< as MeshLab's comments name them
};

/// Parse the bytes of a file. Elements other than `vertex`, `face` and `tristrips` are skipped; so are properties with
/// other names than those that programs give to coordinates, normals, texture coordinates and corners. Strips become
/// triangles; -1 starts another.
/// Source: G. Turk, "The PLY Polygon File Format", 1994; `texcoord` and `texnumber` of faces: VCGlib.
/// @returns false, with the reason in `error`, if the header is invalid, the body ends early or has what is no number,
///          a face uses a vertex that does not exist, or has texture coordinates for other than all of its corners
bool parse(File& dst, const std::string& bytes, std::string& error);

} // namespace vmlight::ply
