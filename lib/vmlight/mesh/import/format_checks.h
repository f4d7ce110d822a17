// SPDX-License-Identifier: Apache-2.0
/// Detection and inspection of the formats that assimp reads. Detection looks at the start of a file; inspection looks
/// at all of it, for what is known to crash assimp 5.2, to hang it, or to come out of it as something else.
#pragma once

#include <vmlight/mesh/import/importer.h>
#include <vmlight/mesh/import/node_graph.h>

#include <Imath/ImathVec.h>
#include <OpenImageIO/string_view.h>

#include <string>
#include <vector>

namespace vmlight {

/// The text of a file's start, from its first character that is no blank, without a UTF-8 byte order mark.
OIIO::string_view first_text(const FileHead& head);

/// Beyond this many times the longest side of its bounding box from the origin, floats would round a mesh by more than
/// 1e-6 of its size, which is about the smallest gap between surfaces that is resolved (surface.h).
constexpr double kFarFromOrigin = 16;

/// Is a coordinate of these vertices more than kFarFromOrigin times the longest side of their bounding box? False if
/// one is not finite, or if all are equal.
bool is_far_from_origin(const std::vector<Imath::V3d>& positions);

/// STL: starts with "solid", or has the size that the triangle count of a binary file asks for.
bool is_stl(const FileHead& head);

/// Collada: XML, in 8 or 16 bits, with "<collada" near its start, in any case.
bool is_collada(const FileHead& head);
/// Refuses elements nested deeper than the limit, through which assimp recurses; a scene of more nodes than the limit
/// once each instance_node is expanded, as assimp 5.2 does, by the names it looks up; a node that is its own ancestor.
/// Invalid XML is left to assimp: only what comes before the error is checked. Source: Khronos, Collada 1.4.1
/// specification, `instance_node`.
Inspection inspect_collada(const std::string& text, const NodeLimits& limits);
inline Inspection inspect_collada(const std::string& text)
{
    return inspect_collada(text, {});
}

/// FBX: starts as a binary file does, or as text does: with a comment or a header that names FBX.
bool is_fbx(const FileHead& head);
/// For Models of FBX files: `nodes` is how many more than the connections may come of copies under several parents,
/// which no exporter is known to write. assimp makes up to 18 nodes of each Model.
constexpr NodeLimits kFbxLimits { 50000, 5000 };
/// Refuses what read_fbx_records() does; a Model that is its own ancestor; Models deeper than the limit, or, once each
/// is expanded under all its parents, as assimp does, more than the connections and the limit. Connections of other
/// objects (skins, clusters, geometries) may be cyclic and are not checked. All else is left to assimp. Source:
/// assimp 5.2, FBXDocument.cpp and FBXConverter.cpp.
Inspection inspect_fbx(const std::string& bytes, const NodeLimits& limits);
inline Inspection inspect_fbx(const std::string& bytes)
{
    return inspect_fbx(bytes, kFbxLimits);
}

} // namespace vmlight
