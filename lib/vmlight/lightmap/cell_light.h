// SPDX-License-Identifier: Apache-2.0
/// The environment's light sorted into the direction grid, at one rotation: what the models `mask` and `cells` sum.
#pragma once

#include <vmlight/math/direction_grid.h>
#include <vmlight/math/rotation.h>

#include <OpenImageIO/imagebuf.h>

#include <string>
#include <vector>

namespace vmlight {

/// Int (L - mean) w dw of cells, three colours and, as the fourth, Int w dw alone: four floats for x, four for y, four
/// for z; then Int (L - mean) dw and the solid angle. Light less its mean, so that a constant environment leaves
/// nothing but exact zeros.
constexpr int kMomentFloats = 16;

struct CellLight
{
    /// For `mask`: of each column, at each edge between slices, the sum of the slices below.
    std::vector<float> running;
    /// For `cells`: of three cells at a time, the sum for each of the 64 ways in which they can be seen.
    std::vector<float> triples;
    /// Mean of the environment over the sphere, and the bounds within which all means of it lie.
    float mean[3] = { 0, 0, 0 }, least[3] = { 0, 0, 0 }, most[3] = { 0, 0, 0 };
};

/// How many thirds of three cells are seen, in six bits; the first cell uppermost.
constexpr int kTriples = direction_grid::kCells / 3, kTripleCodes = 64;

/// Sort the pixels of `radiance` into the grid of the object's space.
///
/// A pixel, cut into nearly square parts, is spread over the cells that patches of their size cover, so that the sums,
/// hence the picture, change without a jump as the object turns, and keep all light. More pixels than 256x128 are
/// reduced to that first: the grid is coarser by far.
///
/// @param radiance     as make_radiance() makes it
/// @param to_object    takes directions of the environment to the object's
/// @param triples      whether `cells` is what it is for; else `running` alone is made
/// @returns false, with the reason in `error`, if the image is none that prepare_cfem() would take.
bool build_cell_light(CellLight& dst, const OIIO::ImageBuf& radiance, const Rotation& to_object, bool triples,
                      std::string& error);

} // namespace vmlight
