// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Imath/ImathVec.h>

namespace vmlight {

/// All that tells one vertex from another, as a key of UniqueIndex.
struct VertexKey
{
    Imath::V3d position;
    Imath::V3f normal;
    Imath::V2f uv;
    float padding = 0; // initialised: all bytes of a key are compared
};
static_assert(sizeof(VertexKey) == 48);

} // namespace vmlight
