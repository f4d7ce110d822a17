// SPDX-License-Identifier: Apache-2.0
/// Parts of a mesh that visibility maps have no texel for.
#pragma once

#include <vmlight/mesh/mesh.h>
#include <vmlight/stage/make_options.h>
#include <vmlight/uv/report.h>

#include <OpenImageIO/span.h>

#include <string>

namespace vmlight {

/// A warning of triangles that reach outside all UDIM tiles, or "".
std::string beyond_udims_warning(const UvReport& uv);
/// A warning of triangles without UVs, or "".
std::string without_uv_warning(const UvReport& uv);

/// Warn of what no map of `tiles` has: both of these, and other tiles that the mesh uses. Each line begins with the
/// name of the mesh.
void warn_of_uvs(const Mesh& mesh, OIIO::cspan<int> tiles, const MakeOptions& options);

} // namespace vmlight
