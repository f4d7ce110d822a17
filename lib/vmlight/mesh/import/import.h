// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Imath/ImathVec.h>

#include <string>
#include <vector>

namespace vmlight {

/// What a mesh file is like, seen before the mesh importer (assimp) sees it.
struct MeshFile
{
    /// Why the importer must not be given the file, or "". It looks for what is known to crash assimp 5.2, to hang it,
    /// or to come out of it as something else: a PLY whose header or body ends early or whose faces ask for vertices
    /// that it has not, texture coordinates of an OBJ that are not finite, nodes of a glTF, a Collada file or an FBX
    /// that are under themselves or more than memory holds; and archives.
    std::string fault;

    /// The vertices in the file's order and double precision, of an OBJ or of a PLY with `double` coordinates that lies
    /// so far from the origin that the importer's floats would lose its shape; else empty.
    std::vector<Imath::V3d> positions;

    /// What the importer is to read instead of the file, or "": a PLY of vertices, faces and strips alone, without
    /// blank lines, because assimp 5.2 loses its place at others; an OBJ whose vertices tell their numbers,
    /// or without what it does not understand (a byte order mark, indents, backslashes in comments).
    std::string stand_in;

    /// Is vertex number n of the stand-in at (n % 2^16, n / 2^16, 0), so that the importer tells which vertex it made
    /// of which? So is that of an OBJ that has `positions`.
    bool is_numbered = false;
};

/// Read the file once. One that cannot be read has neither fault nor positions.
MeshFile inspect_mesh_file(const std::string& path);

/// Of a file whose greatest coordinate is more than this many times its greatest side, float would round the shape by
/// more than 1e-6 of its size, which is about how near to each other surfaces can be told apart (surface.h).
constexpr double kFarFromOrigin = 16;

/// Do these vertices lie so far away? False if one is not finite, or if all are one.
bool lie_far_from_origin(const std::vector<Imath::V3d>& positions);

} // namespace vmlight
