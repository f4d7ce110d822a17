// SPDX-License-Identifier: Apache-2.0
/// Meshes: files, or arrays.
#pragma once

#include "function.h"

#include <vmlight/mesh/mesh.h>

#include <pybind11/pybind11.h>

#include <memory>
#include <string>
#include <vector>

namespace vmlight::python {

/// A mesh and its occluders: all of them files, or all of them in memory.
struct MeshInput
{
    std::string mesh_path;
    std::vector<std::string> occluder_paths;
    std::shared_ptr<const Mesh> mesh; ///< nullptr: files
    std::vector<Mesh> occluders;

    /// The files, for do_work().
    std::vector<std::string> paths() const;
};

/// The operands for it, by the names `mesh` and `occluder`.
Operand mesh_operand();
Operand occluder_operand();

/// Throws TypeError if some are files and some in memory.
MeshInput mesh_input(py::handle mesh, py::handle occluder);

/// Throw TypeError if a keyword of the call is none of `names`: it is for `what` alone.
void allow_only(const Call& call, const std::vector<std::string>& names, const char* what);

/// Add vmlight.Mesh.
void define_mesh(py::module_& m);

} // namespace vmlight::python
