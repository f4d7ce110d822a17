// SPDX-License-Identifier: Apache-2.0
/// The inner loop of the exact filter: the light of one circle of latitude of the environment in one row of the result,
/// when only an arc of the circle is above each pixel's horizon.
#pragma once

#include <cstdint>

namespace vmlight {

/// Prefix integrals from longitude 0 to anywhere in one pixel of a row of the environment (R, G, B and a spare lane):
///     Int L dphi     = zero + slope phi
///     Int L cos dphi = cosine + slope sin phi
///     Int L sin dphi = sine - slope cos phi
/// where slope is the pixel's L, so that the ends of an arc need no trigonometry.
struct alignas(64) PrefixCell
{
    double zero[4], slope[4], cosine[4], sine[4];
};

/// Longitude of a column of the result.
struct ColumnAngle
{
    double phi, cosine, sine;
};

/// Arcs around a run of columns. In column c the arc ends at cells (end[0] + c step) >> 32 and, at its beginning,
/// (end[1] + c step) >> 32, in fixed point of 32 fraction bits; a cell too far left or right by rounding
/// does no harm, because prefix integrals are continuous.
struct ArcRun
{
    int first, last; ///< columns, `last` excluded
    int64_t end[2], step; ///< cells
    double upward, sideward; ///< weight times a and b of n.w = a + b cos(phi - phi_column)
    double slope_at_end[2]; ///< factors of the slopes are upward phi_column + slope_at_end
};

/// Sums of a column: add the halves to get R, G, B. Two halves so that the loop is two vectors of four lanes.
struct alignas(64) ColumnSum
{
    double half[2][4];
};

/// Add to sums[c], for each column c of the run, the integral of L (a + b cos(phi - phi_c)) over its arc.
/// `cells` must be readable one cell left and right of the row. Vectorised, for the CPU that it runs on.
void add_arcs(ColumnSum* sums, const PrefixCell* cells, const ColumnAngle* columns, const ArcRun& run);
/// The same in scalar code; add_arcs() differs from it only by rounding.
void add_arcs_scalar(ColumnSum* sums, const PrefixCell* cells, const ColumnAngle* columns, const ArcRun& run);

} // namespace vmlight
