// SPDX-License-Identifier: Apache-2.0
/// The sphere cut into cells: 16 columns of longitude, each into 63 slices of equal height, so that all cells have the
/// same solid angle. What the models `mask` and `cells` store of a texel's visibility, and sum the light of.
///
/// Columns begin at s = 0 of latlong.h and go round with s, in object space. An edge between slices, 0 at y = -1 and 63
/// at y = 1, fits six bits; nine bands of seven slices make 144 larger cells.
#pragma once

#include <Imath/ImathVec.h>

#include <array>
#include <cstdint>

namespace vmlight::direction_grid {

constexpr int kColumns = 16, kSlices = 63, kBands = 9;
constexpr int kSlicesPerBand = kSlices / kBands;
constexpr int kCells = kColumns * kBands;

/// y of an edge between slices.
constexpr double edge(int slice)
{
    return 2.0 * slice / kSlices - 1;
}

/// The column that looks along (x, z), of any length: by comparisons alone, so that it is the same on every machine.
/// A direction on the border of two belongs to the one further on. (0, 0) is in column 0.
inline int column_of(float x, float z)
{
    // Longitude 2 pi s has the cosine -z and the sine x. Turned by quarters until it lies in [0, pi/2).
    float a = -z, b = x;
    int quarter = 0;
    if (a <= 0 && b > 0)
        quarter = 1, a = x, b = z;
    else if (a < 0 && b <= 0)
        quarter = 2, a = z, b = -x;
    else if (a >= 0 && b < 0)
        quarter = 3, a = -x, b = -z;
    constexpr float kTan22 = 0.41421356f, kTan67 = 2.4142136f;
    return 4 * quarter + (b > 0 && b >= kTan22 * a) + (b > 0 && b >= a) + (b > 0 && b >= kTan67 * a);
}

/// Which of `count` slices of equal height holds a direction with this y, which may round beyond [-1, 1].
inline int slice_of(float y, int count = kSlices)
{
    const int slice = int((y + 1) * (0.5f * float(count)));
    return slice < 0 ? 0 : slice < count ? slice : count - 1;
}

/// The horizontal unit vector in the middle of a column.
Imath::V3d column_middle(int column);

/// For each column the running sums of Int w dw over its slices: at [column][slice] of all those below edge `slice`.
using RunningMoments = std::array<std::array<Imath::V3d, kSlices + 1>, kColumns>;
const RunningMoments& running_moments();

} // namespace vmlight::direction_grid
