// SPDX-License-Identifier: Apache-2.0
/// The statements of an OBJ file that matter to a mesh.
/// Source: Wavefront, "Object Files (.obj)", Advanced Visualizer Manual, appendix B1; what writers do where it is
/// silent.
#pragma once

#include <vmlight/mesh/mesh.h>

#include <Imath/ImathVec.h>

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

namespace vmlight::obj {

/// Indices from 0, into what the whole file defines; -1 for none.
struct Corner
{
    int32_t vertex, uv, normal;
};

/// What holds for a run of faces.
struct State
{
    int32_t node = -1; ///< of File::nodes
    int32_t material = -1; ///< of File::materials
    uint32_t smoothing = 0; ///< kSmoothGroup if the file has no `s`
    uint32_t part = 0; ///< smoothing groups join faces within one part only
};

struct Face
{
    uint32_t end; ///< the corner behind its last; its first is the last face's end
    uint32_t line;
    uint32_t state; ///< of File::states
};

struct Library
{
    std::string names; ///< as `mtllib` has them
    size_t line;
};

struct File
{
    std::vector<Imath::V3d> positions;
    std::vector<Imath::V3f> rounded_positions; ///< see TextNumber::rounded
    std::vector<Imath::V2f> uvs;
    std::vector<Imath::V3f> normals; ///< of any length, or not finite
    std::vector<Corner> corners;
    std::vector<Face> faces;
    std::vector<State> states;
    /// Objects (`o`), and below them groups (`g`): `g a b` is b below a.
    std::vector<MeshNode> nodes;
    std::vector<std::string> materials; ///< as `usemtl` names them, in order of first use
    std::vector<Library> libraries;
    std::vector<std::string> ignored; ///< keywords of statements whose geometry is not read
};

/// Parse the text of a file.
///
/// A vertex is its first three numbers: a weight is for curves alone, colours are not used. Free-form geometry, points
/// and lines are skipped.
///
/// Before the first `s` of a file that has one, faces are flat: that is the state a file starts in, and writers put an
/// `s` before the first face that is smooth. Without any `s` all faces are smooth.
///
/// A part starts at each `o`, and at the first face behind new vertices: of files without `o`, those are the objects.
/// A `g` holds until the next; `o` ends it, unless no face has been in it yet: some writers put it before `o`.
///
/// @returns false, with the reason and the line in `error`, if numbers are missing or are none, texture coordinates are
///          not finite, or a face uses what does not exist
bool parse(File& dst, const std::string& text, std::string& error);

} // namespace vmlight::obj
