// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vmlight/mesh/mesh.h>

#include <string>

namespace vmlight {

/// Moments of a mesh that other formats and programs keep when they write it, whatever they do to the order of vertices
/// and the last digits of numbers: the count of triangles; means over the surface of position, UV, their products, and
/// of normals. In object space. As numbers in text, for same_shape(). "" of a mesh without area, or with instances or
/// strands. The same for any number of threads.
std::string mesh_shape(const Mesh& mesh);

/// Whether two texts of mesh_shape() are of one mesh, but for rounding: by a 100,000th of its size. False for "" and
/// what is not such a text.
bool same_shape(const std::string& a, const std::string& b);

} // namespace vmlight
