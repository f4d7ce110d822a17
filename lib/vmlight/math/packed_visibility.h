// SPDX-License-Identifier: Apache-2.0
/// A texel's visibility on the direction grid, packed into integers below 2^24 for the channels `mask.0` ... and
/// `cells.0` .... A float stores them exactly, half does not, and averages of them are meaningless: such maps must not
/// be filtered or mipmapped.
#pragma once

#include <vmlight/math/direction_grid.h>
#include <vmlight/math/ray_fan.h>

#include <Imath/ImathVec.h>

#include <cstdint>
#include <vector>

namespace vmlight {

/// One column of `mask`: slices `low` up to `high` (exclusive) are visible, by `density` fifteenths; 0, 0, 0 if none
/// is. Two floats store three columns of 16 bits.
constexpr int kMaskFloats = 11;
struct MaskColumn
{
    int low = 0, high = 0, density = 0;
};
void pack_mask(float* packed, const MaskColumn* columns);
/// Unpack one column, from integers below 2^24. `low` and `high` are at most 63, whatever the map contains.
inline MaskColumn unpack_mask(const uint32_t* packed, int column)
{
    const uint32_t* pair = packed + column / 3 * 2;
    const uint32_t code = column % 3 == 0 ? pair[0] >> 8
        : column % 3 == 1                 ? (pair[0] & 255) << 8 | pair[1] >> 16
                                          : pair[1] & 0xffff;
    return { int(code >> 10), int(code >> 4 & 63), int(code & 15) };
}

/// `cells`: the visible fraction of each of the 144 cells, band by band from y = -1 up, in thirds of that of the most
/// visible cell. A float stores twelve cells of two bits, the first in the highest bits.
constexpr int kCellsFloats = 12;
constexpr int kCellsPerFloat = direction_grid::kCells / kCellsFloats;
void pack_cells(float* packed, const uint8_t* thirds);

/// Bins the rays of a texel by direction. Use one per thread.
class VisibilityGrid
{
public:
    VisibilityGrid();

    /// Set the counts from one texel's rays: `traced` has a bit for each traced ray, fan.lanes for each unoccluded one.
    /// Rays must be distributed by the cosine around the normal.
    void set_rays(const RayFan& fan, const std::vector<uint8_t>& traced);

    /// The visibility in the encoding of `mask` or `cells`. A cell without rays, above the horizons of both the shading
    /// `normal` and the geometric normal `surface`, gets the visibility of the nearest cell in its column that has
    /// rays; a column without rays gets that of the whole hemisphere.
    void mask(float* packed, const Imath::V3d& normal, const Imath::V3d& surface) const;
    void cells(float* packed, const Imath::V3d& normal, const Imath::V3d& surface) const;

private:
    // Four times the stored resolution, to place edges between rays.
    static constexpr int kFine = 4 * direction_grid::kSlices;
    struct Count
    {
        uint32_t traced, visible;
    };
    MaskColumn column_with_rays(int column, const Imath::V3d& normal) const;
    MaskColumn column_without_rays(int column, const Imath::V3d& normal, const Imath::V3d& surface) const;

    std::vector<Count> m_counts; // kColumns times kFine
    uint32_t m_used = 0; // a bit per column with rays
    int64_t m_traced = 0, m_visible = 0;
};

} // namespace vmlight
