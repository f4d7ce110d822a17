// SPDX-License-Identifier: Apache-2.0
/// Files of strands of every supported format.
#pragma once

#include <vmlight/mesh/import/importer.h>
#include <vmlight/mesh/mesh.h>
#include <vmlight/mesh/strands.h>

#include <string>

namespace vmlight {

/// Whether a file holds nothing but strands, by its content, and by its name where that cannot tell: TressFX, HAIR, and
/// Alembic with curves and no meshes. OBJ and glTF may hold both, without a radius; of those the caller knows what is
/// wanted.
bool is_strand_file(const std::string& path);

/// Whether a file of a format that may hold both, OBJ, glTF or Alembic, has lines and no triangles. Reads all of it.
bool has_lines_alone(const std::string& path);

/// Read the strands of a TressFX 4 .tfx, a .hair (Cem Yuksel's), an OBJ (its `l` statements), a glTF 2.0 (primitives of
/// mode LINE_STRIP, each at the places of its nodes) or an Alembic file (curves that are shown, at their places, if
/// vmlight is built with the Alembic library). The format is detected by content, and by the extension only where
/// content cannot tell.
///
/// An `l` that starts at the vertex where the one before it ended goes on with that strand: writers put each edge in a
/// statement of its own. A .hair may have the radius, half its thickness, and Alembic half its width, if all curves
/// have one. The others have none; the thickness of a .tfx is a factor of a radius that is not in the file, and is not
/// used.
///
/// @param params   only `up` is used, and of Alembic `frame` and `fps`
/// @param radius   see set_radius()
/// @param error    set to the reason, with the path in quotes, if the result is false
/// @returns false if the file cannot be read, ends early, has no strand, has numbers or indices that cannot be,
///          set_radius() or check_strands() refuses it, a strand of a glTF is skinned or morphed, or a curve is
///          closed.
bool read_strands(Strands& dst, const std::string& path, const MeshParams& params, const std::string& radius,
                  std::string& error, const BeforeOpen& before_open = {});

} // namespace vmlight
