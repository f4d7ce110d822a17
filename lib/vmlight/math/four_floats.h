// SPDX-License-Identifier: Apache-2.0
/// Four floats side by side, as every processor here has them: R, G, B and one more. GCC's and Clang's own vectors, for
/// code that need not know the processor; what does is written with Highway (shade_vectors-inl.h).
#pragma once

#include <cstring>

namespace vmlight {

using FourFloats = float __attribute__((vector_size(16)));

inline FourFloats load_four(const float* from)
{
    FourFloats four;
    std::memcpy(&four, from, sizeof(four));
    return four;
}

inline FourFloats all_four(float value)
{
    return FourFloats { value, value, value, value };
}

} // namespace vmlight
