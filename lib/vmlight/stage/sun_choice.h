// SPDX-License-Identifier: Apache-2.0
/// Whether a lightmap's suns and its bounce can be traced, before anything is.
#pragma once

#include <vmlight/cfem/suns.h>
#include <vmlight/stage/recipe/chain.h>
#include <vmlight/stage/recipe/recipe.h>

#include <OpenImageIO/imagebuf.h>

#include <string>
#include <vector>

namespace vmlight {

/// Why the mesh of the map is not known, in a clause that begins with `name`, of the map; "" if it is.
std::string why_no_mesh(const LightmapRecipe& recipe, const std::string& name);
/// Why nothing can be traced on the map with this header, in such a clause; or "".
std::string why_no_trace(const LightmapRecipe& recipe, const OIIO::ImageSpec& vismap, const std::string& name);
/// The same of the bounce, which needs an albedo too.
std::string why_no_bounce(const LightmapRecipe& recipe, const OIIO::ImageSpec& vismap, const std::string& name);
/// The same of suns, whose visibility the map may store.
std::string why_no_suns(const LightmapRecipe& recipe, const OIIO::ImageSpec& vismap, const std::string& name);

/// Set `dst` to the suns that the light of `recipe` has, whatever its key `suns` is; none if it is filtered with them.
/// False, with the reason in `error`, if an input cannot be read.
bool suns_of_light(std::vector<Sun>& dst, const LightmapRecipe& recipe, std::string& error, const RecipeChain& chain);

/// The share of `suns` in all light, 0 to 1; 0 without suns.
///
/// @param light    a CFEM, or the environment: float, in memory
/// @param is_rest  whether the suns are no longer in it
double sun_share(const std::vector<Sun>& suns, const OIIO::ImageBuf& light, bool is_rest);

} // namespace vmlight
