// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vmlight/stage/recipe/recipe.h>

#include <OpenImageIO/imageio.h>

namespace vmlight {

/// Add to the description of a map what its recipe says of the mesh, in metadata.
void append_mesh_metadata(OIIO::ImageSpec& spec, const VismapRecipe& recipe);
/// And why the map is not reconstructed, though the recipe `given`, before its switches, asks for it.
void append_no_reconstruct(OIIO::ImageSpec& spec, const VismapRecipe& given);

} // namespace vmlight
