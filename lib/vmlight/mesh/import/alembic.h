// SPDX-License-Identifier: Apache-2.0
/// Alembic files, read by the room alembic/ if vmlight is built with the Alembic library.
#pragma once

#include <vmlight/mesh/import/importer.h>

#include <string>

namespace vmlight {

/// Starts as Ogawa, which Alembic files are stored in, or as HDF5, which they were stored in until 2013.
bool is_alembic(const FileHead& head);

/// Why a file that starts like this is not read, or "": it is HDF5, or was never finished.
std::string alembic_fault(const FileHead& head);

/// MeshFormat::read of .abc: polygon meshes, and subdivision surfaces as their control cages, each at its place, at
/// MeshParams::frame. Normals that it lacks are smooth. Without the Alembic library always an error, which says what to
/// do. See docs/conventions.md.
bool read_alembic(MeshBuilder& dst, const ImportRequest& request, std::string& error);

} // namespace vmlight
