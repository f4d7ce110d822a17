// SPDX-License-Identifier: Apache-2.0
/// The light of the environment binned into the direction grid, at one rotation, for the models `mask` and `cells`.
#pragma once

#include <vmlight/lightmap/moment_table.h>
#include <vmlight/math/direction_grid.h>
#include <vmlight/math/rotation.h>

#include <OpenImageIO/imagebuf.h>

#include <array>
#include <string>
#include <vector>

namespace vmlight {

/// Of a cell: R, G, B of Int (L - mean) w dw and Int w dw, four numbers each for x, y and z; then Int (L - mean) dw and
/// the solid angle. The mean is subtracted so that a constant environment gives exact zeros.
using CellMoments = std::array<double, 16>;

/// What all texels are shaded with.
struct EnvironmentBounds
{
    /// Mean of the environment over the sphere, and its smallest and largest values.
    float mean[3] = { 0, 0, 0 }, least[3] = { 0, 0, 0 }, most[3] = { 0, 0, 0 };
    /// From find_brightest_light().
    float brightest[3] = { 0, 0, 0 };
};

struct CellLight : EnvironmentBounds
{
    /// Sums of moments for each code of a part of a texel; kMaskStride or kCellsStride entries for each part.
    std::vector<PackedMoments> moments;
    /// What 1 of the fixed point stands for: R, G, B and the weight.
    float unit[4] = { 0, 0, 0, 0 };
    /// R, G, B of the moments without w, and a 0. For `mask`: for each column and each edge between slices, the sum of
    /// the slices below. For `cells`: for three cells at a time, the sum for each of the 64 combinations of their
    /// visibility.
    std::vector<float> plain;
};

/// `mask`: for each column, for each edge and density (code low 10 bits), density times the sum of the slices below the
/// edge. `cells`: for each four cells, the sum for each of the 256 combinations of their visibility in thirds, the
/// first cell in the highest bits. One cache line between the parts keeps equal codes of all parts out of one set of
/// the cache.
constexpr int kMaskCodes = 1024, kCellsCodes = 256, kCellsParts = direction_grid::kCells / 4;
constexpr int kMaskStride = kMaskCodes + 2, kCellsStride = kCellsCodes + 2;
/// Of `plain` of `cells`: the visibility of three cells in thirds, in six bits; the first cell is the highest.
constexpr int kTriples = direction_grid::kCells / 3, kTripleCodes = 64;

/// Bin the pixels of `radiance` into the grid, in object space: moments of kColumns times kSlices cells, and what else
/// the models need to know.
///
/// Each pixel is cut into nearly square patches, and each patch is spread over the cells that it covers: no light is
/// lost, and the sums, hence the picture, are continuous as the object turns. Images of more than 256x128 pixels are
/// reduced to that first, still much finer than the grid.
///
/// @param radiance     as make_radiance() makes it
/// @param to_object    rotates directions from environment to object space
/// @returns false, with the reason in `error`, if prepare_cfem() would refuse the image.
bool bin_environment(std::vector<CellMoments>& cells, EnvironmentBounds& bounds, const OIIO::ImageBuf& radiance,
                     const Rotation& to_object, std::string& error);

/// The tables of `mask` and of `cells`, of what bin_environment() finds. Sums of a texel are off by at most 2e-5 of the
/// sum over the sphere, by 2e-6 on average.
bool build_mask_light(CellLight& dst, const OIIO::ImageBuf& radiance, const Rotation& to_object, std::string& error);
bool build_cells_light(CellLight& dst, const OIIO::ImageBuf& radiance, const Rotation& to_object, std::string& error);

} // namespace vmlight
