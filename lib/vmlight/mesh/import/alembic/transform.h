// SPDX-License-Identifier: Apache-2.0
/// The transform of an object.
#pragma once

#include <vmlight/mesh/import/alembic/properties.h>

#include <Imath/ImathMatrix.h>

namespace vmlight::alembic {

struct Transform
{
    Imath::M44d matrix; ///< for row vectors, as everywhere in Imath
    bool exists = false;
    bool inherits = true; ///< false: from the top of the file, whatever the parents do
};

/// The transform that the object with these properties has, the identity if it has none. Between two samples each
/// number of each operation is interpolated, so that a turn by 360 degrees turns; of matrices translation, scale,
/// shear, and the rotation along its shortest arc.
///
/// Throws Error if an operation is unknown, or lacks numbers.
/// Source: Alembic 1.8, XformSample::getMatrix().
Transform read_transform(const AbcA::CompoundPropertyReaderPtr& properties, Moment& moment);

} // namespace vmlight::alembic
