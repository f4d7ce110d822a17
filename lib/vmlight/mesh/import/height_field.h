// SPDX-License-Identifier: Apache-2.0
/// Terrain from an image of heights.
#pragma once

#include <vmlight/mesh/import/importer.h>

#include <string>

namespace vmlight {

/// EXR, TIFF or PNG: what heights are stored in.
bool is_height_field(const FileHead& head);

/// "1.5m/px" or "1.5": how far apart pixels are, in mesh units. False, with the reason in `error`, if it is not a
/// number above 0, alone or with this unit.
bool parse_pixel_spacing(double& dst, const std::string& text, std::string& error);

/// Read the heights of an image as a grid with a vertex in the middle of each pixel: see read_mesh().
bool read_height_field(MeshBuilder& dst, const ImportRequest& request, std::string& error);

} // namespace vmlight
