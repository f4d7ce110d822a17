// SPDX-License-Identifier: Apache-2.0
/// The materials of OBJ files.
/// Sources: Wavefront, "MTL material format (Lightwave, OBJ)", Advanced Visualizer Manual, appendix B2; `norm`:
/// Exocortex, "Extending the Wavefront MTL format to support PBR", 2015.
#pragma once

#include <vmlight/mesh/material.h>

#include <string>
#include <vector>

namespace vmlight {

/// Add the materials of an MTL file's text to `materials`; one that is there already is added to. Never fails: what
/// cannot be read is as if it were not there.
///
/// `Kd` is linear. Opacity is `d`, or 1 - `Tr` where there is no `d`; with less than 1, or `map_d`, the material
/// blends. Where `map_d` is the image of `map_Kd`, opacity is that image's alpha. Only `norm` is a normal map:
/// `map_Bump`, `bump` and `disp` are heights. A texture without `Kd`, or with a black one, is as it is.
/// @param folder   of the file, where the paths of textures start
void add_mtl_materials(std::vector<Material>& materials, const std::string& text, const std::string& folder);

} // namespace vmlight
