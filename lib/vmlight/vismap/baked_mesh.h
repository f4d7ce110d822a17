// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vmlight/mesh/mesh.h>

#include <OpenImageIO/imageio.h>

namespace vmlight {

/// Whether the map with these metadata was baked of `mesh`, or of one that only rounding and the order of vertices tell
/// from it: --write-mesh and other programs write such meshes. True if the map does not say of which mesh it is.
bool is_baked_of(const Mesh& mesh, const OIIO::ImageSpec& vismap);

} // namespace vmlight
