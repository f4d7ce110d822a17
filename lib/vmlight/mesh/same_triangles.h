// SPDX-License-Identifier: Apache-2.0
/// Poses: meshes that differ in where their triangles are, and in nothing else that a map knows of.
#pragma once

#include <vmlight/mesh/mesh.h>

#include <string>

namespace vmlight {

/// How the triangles of `pose` are not those of `mesh`, in number or texture coordinates: a sentence, or "". Vertices
/// may be numbered differently.
std::string triangles_fault(const Mesh& mesh, const Mesh& pose);

} // namespace vmlight
