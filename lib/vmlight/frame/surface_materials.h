// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vmlight/frame/frame_scene.h>
#include <vmlight/mesh/mesh.h>
#include <vmlight/stage/make_options.h>

#include <string>
#include <vector>

namespace vmlight {

/// Read what the materials of a mesh file look like: base colour, its texture, and alpha, converted to the space of the
/// light. A texture that cannot be read, or is not there, is warned of and left out.
///
/// @param light_space  interop id of the light's space
/// @param colorconfig  OCIO config; "" means $OCIO
/// @returns false, with the reason in `error`, if the config cannot be used
bool read_materials(std::vector<SurfaceMaterial>& dst, const Mesh& mesh, const std::string& light_space,
                    const std::string& colorconfig, const MakeOptions& options, std::string& error);

} // namespace vmlight
