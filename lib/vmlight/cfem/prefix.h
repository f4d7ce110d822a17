// SPDX-License-Identifier: Apache-2.0
/// Prefix integrals along a row of the environment.
#pragma once

#include <vmlight/cfem/kernel.h>

#include <vector>

namespace vmlight {

/// The light of a whole circle for direction n is n.y zero + sin theta_n (cos phi_n cosine + sin phi_n sine).
struct Moments
{
    double zero[3] = {}, cosine[3] = {}, sine[3] = {};

    void add(double upward, double sideward, const Moments& m)
    {
        for (int k = 0; k < 3; ++k) {
            zero[k] += upward * m.zero[k];
            cosine[k] += sideward * m.cosine[k];
            sine[k] += sideward * m.sine[k];
        }
    }
    double toward(const ColumnAngle& column, int k) const
    {
        return zero[k] + column.cosine * cosine[k] + column.sine * sine[k];
    }
};

/// Sums of a row of the environment, and the largest sum of L over about 1/32 of the circle.
struct RowLight
{
    Moments total;
    double brightest[3] = {};
};

/// Set the cells of a row: width + 2, with a spare one at either end, since fixed-point positions may round to one cell
/// outside.
///
/// @param pixels   R, G, B of the row
/// @param edges    the columns' edges, one more than columns, from 0 to 2 pi
RowLight make_prefix(PrefixCell* cells, const float* pixels, const std::vector<ColumnAngle>& edges);

} // namespace vmlight
