// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vmlight/mesh/import/mesh_builder.h>

#include <cmath>
#include <string>
#include <vector>

namespace vmlight {

/// Heights at the middles of pixels, row by row from the top, NaN where there is no ground.
struct HeightGrid
{
    int columns = 0, rows = 0;
    std::vector<float> heights;
    /// Between pixels, in mesh units, like the heights.
    double spacing = 1;
    /// The first pixel, counted from that of the whole picture, and its size.
    int left = 0, top = 0, full_columns = 0, full_rows = 0;

    float at(int column, int row) const { return heights[size_t(row) * size_t(columns) + size_t(column)]; }
    bool has(int column, int row) const
    {
        return column >= 0 && row >= 0 && column < columns && row < rows && !std::isnan(at(column, row));
    }
};

/// Append the triangles of all quads of neighbouring pixels. The picture is the view from above: its right is +x, its
/// bottom +z, its middle the origin; y is up. Pixel (i, j) has the texture coordinates of its middle. A quad is cut
/// along the diagonal whose ends differ less in height; of one with three heights that triangle is made, of less none.
/// Normals are those of central differences. Says in a warning how many pixels have no ground.
/// @returns false, with the reason in `error`, if there is no triangle
bool append_height_grid(MeshBuilder& dst, const HeightGrid& grid, std::string& error);

} // namespace vmlight
