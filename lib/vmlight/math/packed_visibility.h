// SPDX-License-Identifier: Apache-2.0
/// What a texel sees, cell by cell of the direction grid, in the few whole numbers below 2^24 that the channels
/// `mask.0` ... and `cells.0` ... hold. A float holds them to the last bit; half floats do not, and means of them mean
/// nothing: such maps are neither filtered nor mipped.
#pragma once

#include <vmlight/math/direction_grid.h>
#include <vmlight/math/ray_fan.h>

#include <Imath/ImathVec.h>

#include <cstdint>
#include <vector>

namespace vmlight {

/// `mask`: of each column the slices from `low` up to `high`, of which `density` fifteenths are seen; 0, 0, 0 if
/// nothing is. Three columns of 16 bits stand in two numbers.
constexpr int kMaskFloats = 11;
struct ColumnView
{
    int low = 0, high = 0, density = 0;
};
void pack_mask(float* packed, const ColumnView* columns);
/// Column `column`, from numbers that are whole and below 2^24. `high` is at most 63, `low` too: nothing that a map may
/// hold leads out of the grid.
inline ColumnView unpack_mask(const uint32_t* packed, int column)
{
    const uint32_t* pair = packed + column / 3 * 2;
    const uint32_t code = column % 3 == 0 ? pair[0] >> 8
        : column % 3 == 1                 ? (pair[0] & 255) << 8 | pair[1] >> 16
                                          : pair[1] & 0xffff;
    return { int(code >> 10), int(code >> 4 & 63), int(code & 15) };
}

/// `cells`: of each of the 144 cells, band by band from y = -1 up, how much is seen, in thirds of what is seen of the
/// cell that is seen best. Twelve cells of two bits, the first uppermost, stand in one number.
constexpr int kCellsFloats = 12;
constexpr int kCellsPerFloat = direction_grid::kCells / kCellsFloats;
void pack_cells(float* packed, const uint8_t* thirds);

/// Sorts the rays of a texel into the grid. One to a thread.
class VisibilityGrid
{
public:
    VisibilityGrid();

    /// Count the rays whose bit is set in `asked`, and those also set in fan.lanes as seen. Rays stand for equal shares
    /// of the cosine around `normal`.
    void take(const RayFan& fan, const std::vector<uint8_t>& asked);

    /// What was counted, as `mask` or `cells` store it. Of cells above the horizon, both that of `normal` and that of
    /// the `surface`, to which no ray went, as much is taken to be seen as of the nearest cell of the column that one
    /// went to; of columns, as of the whole. So few rays end as the share of the hemisphere that is seen.
    void mask(float* packed, const Imath::V3d& normal, const Imath::V3d& surface) const;
    void cells(float* packed, const Imath::V3d& normal, const Imath::V3d& surface) const;

private:
    // Four times as fine as what is stored, for edges that lie between rays.
    static constexpr int kFine = 4 * direction_grid::kSlices;
    struct Count
    {
        uint32_t asked, seen;
    };
    ColumnView view(int column, const Imath::V3d& normal) const;
    ColumnView unasked(int column, const Imath::V3d& normal, const Imath::V3d& surface) const;

    std::vector<Count> m_counts; // kColumns times kFine
    uint32_t m_used = 0; // a bit for each column
    int64_t m_asked = 0, m_seen = 0;
};

} // namespace vmlight
