// SPDX-License-Identifier: Apache-2.0
/// Visibility maps of strands, from recipes whose mesh is a file of strands.
#pragma once

#include <vmlight/stage/open_source.h>
#include <vmlight/stage/scene_cache.h>

#include <string>

namespace vmlight {

/// Open the map that `recipe` bakes of strands. Reads the strands, whose number the size of the map follows from;
/// traces nothing.
///
/// @param recipe   bakes_strands(); recipe_fault() and check_params() have passed it
/// @param key      of the recipe and the files of `stamps`
/// @returns nullptr, with the location and reason in `error`, if the file cannot be read or its map would be too large.
PixelSourcePointer open_strand_map(const VismapRecipe& recipe, const std::string& key, SceneStamps stamps,
                                   const RecipeChain& chain, std::string& error);

} // namespace vmlight
