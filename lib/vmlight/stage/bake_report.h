// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vmlight/stage/make_options.h>
#include <vmlight/stage/recipe/recipe.h>
#include <vmlight/vismap/vismap.h>

#include <OpenImageIO/imageio.h>

namespace vmlight {

/// Report what was baked of `mesh`, and warn of what its file says, of overlap and what would overlap less, of
/// triangles outside the tile or without UVs, islands that cover no texel, triangles too small to start rays from, and
/// a map that is empty or mostly dark.
void report_bake(const MakeOptions& options, const VismapReport& report, const OIIO::ImageSpec& spec,
                 const VismapRecipe& recipe, const Mesh& mesh);

/// That most of a map is dark, or "".
std::string dark_warning(int64_t dark, int64_t covered);

} // namespace vmlight
