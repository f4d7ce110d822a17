// SPDX-License-Identifier: Apache-2.0
/// The curves of an object at one moment.
#pragma once

#include <vmlight/mesh/import/alembic/properties.h>

#include <Imath/ImathVec.h>

#include <cstdint>
#include <vector>

namespace vmlight::alembic {

/// In the space of their object.
struct Curves
{
    std::vector<uint32_t> ends; ///< for each curve, one past its last point
    std::vector<Imath::V3d> points;
    std::vector<double> widths; ///< of each point; empty if the file has none
};

bool is_curves(const AbcA::ObjectHeader& header);

/// Read curves by their points, whatever their basis. Where their numbers of points stay the same, points and widths
/// between two samples are interpolated. Throws Error if a curve is closed or has fewer than two points, or there are
/// not as many points as curves need.
Curves read_curves(AbcA::ObjectReader& object, Moment& moment);

} // namespace vmlight::alembic
