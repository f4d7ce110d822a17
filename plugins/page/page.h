// SPDX-License-Identifier: Apache-2.0
/// A lit object as one HTML file: its mesh, its map and filtered environments, and a WebGL 2 viewer that lights it.
#pragma once

#include <vmlight/export/map_textures.h>
#include <vmlight/lightmap/cfem_lookup.h>
#include <vmlight/lightmap/lobe_lookup.h>
#include <vmlight/mesh/mesh.h>
#include <vmlight/stage/make_options.h>
#include <vmlight/stage/recipe/recipe.h>

#include <string>
#include <vector>

namespace vmlight {

/// The most that a page stores of a map, in texels a side, and the width of its filtered environments.
constexpr int kPageMapSide = 256, kPageLightWidth = 64;

struct PageLight
{
    std::string name;
    CfemLookup cfem;
    LobeLookup lobes;
};

/// Read and filter an environment, for all models of the page, in linear Rec.709. False, with the reason in `error`, if
/// it cannot be read, or is a CFEM and no stack.
bool read_page_light(PageLight& dst, const std::string& path, const CfemRecipe& recipe, const MakeOptions& options,
                     std::string& error);

/// The page. V and B are stored in 16 bits, each within 1/65535; a map with more than kPageMapSide texels a side is
/// reduced by a box filter first.
///
/// @param texels   of `mesh`, with its surface
std::string make_page(const Mesh& mesh, const MapTexels& texels, const TexelSurface& surface,
                      const std::vector<PageLight>& lights);

} // namespace vmlight
