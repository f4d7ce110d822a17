// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vmlight/stage/make_options.h>
#include <vmlight/stage/recipe/recipe.h>
#include <vmlight/vismap/vismap.h>

#include <OpenImageIO/imageio.h>

namespace vmlight {

/// Tell a user what was baked, and warn of what may surprise: overlap, triangles out of the tile or without uvs,
/// islands that cover no texel, triangles too small to start rays from, a map that is empty or mostly dark.
void report_bake(const MakeOptions& options, const VismapReport& report, const OIIO::ImageSpec& spec,
                 const VismapRecipe& recipe);

} // namespace vmlight
