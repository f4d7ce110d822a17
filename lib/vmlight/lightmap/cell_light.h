// SPDX-License-Identifier: Apache-2.0
/// The light of the environment binned into the direction grid, at one rotation, for the models `mask` and `cells`.
#pragma once

#include <vmlight/math/direction_grid.h>
#include <vmlight/math/rotation.h>

#include <OpenImageIO/imagebuf.h>

#include <string>
#include <vector>

namespace vmlight {

/// Floats of a cell: R, G, B of Int (L - mean) w dw and Int w dw, four floats each for x, y and z; then Int (L - mean)
/// dw and the solid angle. The mean is subtracted so that a constant environment gives exact zeros.
constexpr int kMomentFloats = 16;

struct CellLight
{
    /// For `mask`: for each column and each edge between slices, the sum of the slices below.
    std::vector<float> running;
    /// For `cells`: for three cells at a time, the sum for each of the 64 combinations of their visibility.
    std::vector<float> triples;
    /// Mean of the environment over the sphere, and its smallest and largest values.
    float mean[3] = { 0, 0, 0 }, least[3] = { 0, 0, 0 }, most[3] = { 0, 0, 0 };
    /// From find_brightest_light().
    float brightest[3] = { 0, 0, 0 };
};

/// The visibility of three cells in thirds, in six bits; the first cell is the highest.
constexpr int kTriples = direction_grid::kCells / 3, kTripleCodes = 64;

/// Bin the pixels of `radiance` into the grid, in object space.
///
/// Each pixel is cut into nearly square patches, and each patch is spread over the cells that it covers: no light is
/// lost, and the sums, hence the picture, are continuous as the object turns. Images of more than 256x128 pixels are
/// reduced to that first, still much finer than the grid.
///
/// @param radiance     as make_radiance() makes it
/// @param to_object    rotates directions from environment to object space
/// @param triples      whether to fill `triples`, which only `cells` reads
/// @returns false, with the reason in `error`, if prepare_cfem() would refuse the image.
bool build_cell_light(CellLight& dst, const OIIO::ImageBuf& radiance, const Rotation& to_object, bool triples,
                      std::string& error);

} // namespace vmlight
