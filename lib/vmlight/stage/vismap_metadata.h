// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vmlight/stage/recipe/recipe.h>

#include <OpenImageIO/imageio.h>

namespace vmlight {

/// Add to the description of a map what its recipe says of the mesh, in metadata.
void append_mesh_metadata(OIIO::ImageSpec& spec, const VismapRecipe& recipe);

} // namespace vmlight
