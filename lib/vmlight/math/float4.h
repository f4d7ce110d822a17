// SPDX-License-Identifier: Apache-2.0
/// A vector of four floats: R, G, B and padding. Uses the vector extension of GCC and Clang, which every supported CPU
/// implements in one register. Code for wider vectors uses Highway (shade_vectors-inl.h).
#pragma once

#include <cstring>

namespace vmlight {

using Float4 = float __attribute__((vector_size(16)));

inline Float4 load_float4(const float* from)
{
    Float4 four;
    std::memcpy(&four, from, sizeof(four));
    return four;
}

inline Float4 splat_float4(float value)
{
    return Float4 { value, value, value, value };
}

} // namespace vmlight
