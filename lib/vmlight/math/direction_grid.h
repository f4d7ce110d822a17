// SPDX-License-Identifier: Apache-2.0
/// A grid over the sphere of directions: 16 columns of longitude, each with 63 slices of equal height, so that all
/// cells have the same solid angle. The models `mask` and `cells` store visibility and sum light on it.
///
/// Columns start at s = 0 of latlong.h and follow s, in object space. A slice edge, from 0 at y = -1 to 63 at y = 1,
/// fits in six bits. Nine bands of seven slices make 144 larger cells.
#pragma once

#include <Imath/ImathVec.h>

#include <array>
#include <cstdint>

namespace vmlight::direction_grid {

constexpr int kColumns = 16, kSlices = 63, kBands = 9;
constexpr int kSlicesPerBand = kSlices / kBands;
constexpr int kCells = kColumns * kBands;

/// y of a slice edge.
constexpr double edge(int slice)
{
    return 2.0 * slice / kSlices - 1;
}

/// The column that contains the direction (x, z), of any length. Uses comparisons only, so that all machines agree. A
/// direction on a border belongs to the next column; (0, 0) is in column 0.
inline int column_of(float x, float z)
{
    // Longitude 2 pi s has cosine -z and sine x. Rotate by quarter turns into [0, pi/2).
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

/// Which of `count` slices of equal height contains a direction with this y. Clamps y to [-1, 1].
inline int slice_of(float y, int count = kSlices)
{
    const int slice = int((y + 1) * (0.5f * float(count)));
    return slice < 0 ? 0 : slice < count ? slice : count - 1;
}

/// Horizontal unit vector at the centre of a column.
Imath::V3d column_middle(int column);

/// Running sums of Int w dw over the slices of each column: [column][slice] is the sum below edge `slice`.
using RunningMoments = std::array<std::array<Imath::V3d, kSlices + 1>, kColumns>;
const RunningMoments& running_moments();

} // namespace vmlight::direction_grid
