// SPDX-License-Identifier: Apache-2.0
/// What every part of the Alembic reader uses.
#pragma once

#include <stdexcept>

namespace vmlight::alembic {

/// Why a file cannot be read, without its path. Thrown in this room alone, and caught by read_alembic().
struct Error : std::runtime_error
{
    using std::runtime_error::runtime_error;
};

} // namespace vmlight::alembic
