// SPDX-License-Identifier: Apache-2.0
/// Steps that the models share which look light up along a direction: scalar forms, and the constants that the vector
/// forms (lookup_vectors-inl.h) share with them.
#pragma once

#include <vmlight/lightmap/model_shader.h>

#include <cmath>

namespace vmlight {

/// Where no component of B reaches this many times V, what the texel sees is symmetric: it has no direction.
constexpr float kNoDirection = 1e-6f;

/// The largest V gain that is accepted (kLargestVisibility), and for which no lookup can leave float's range.
template <class Lookup> float largest_light(const Lookup& map, float gain)
{
    const float in_range = 1.7e38f / (map.largest > 1 ? map.largest : 1.0f);
    return in_range < kLargestVisibility * gain ? in_range : kLargestVisibility * gain;
}

/// The largest value that a surface can have under this light, in channel `c`: a narrow lobe may see only a sun, but no
/// surface receives more of it than one that faces it. Rounding is left alone.
template <class Lookup> float brightest_light(const Lookup& map, float gain, int c)
{
    return map.brightest[c] * gain * kAboveRounding;
}

/// atan(a) / (2 pi) = a (c0 + c1 a^2 + ...) for a in [0, 1]: minimax, off by at most 6e-9.
constexpr float kAtanTurns[8] = { 0.159154832f,  -0.0530461222f,  0.0317459442f,  -0.022136271f,
                                  0.0153460335f, -0.00889872294f, 0.00347959786f, -0.000645304448f };

/// The angle of (x, y) in turns, in [-0.5, 0.5], off by at most 6e-8 turns (4e-7 radians); quarter turns are exact.
/// (0, 0) has angle 0.
inline float atan2_turns(float y, float x)
{
    const float ax = std::abs(x), ay = std::abs(y);
    const float larger = ax > ay ? ax : ay, smaller = ax > ay ? ay : ax;
    const float a = smaller / (larger > 1.17549435e-38f ? larger : 1.17549435e-38f);
    const float s = a * a;
    float r = kAtanTurns[7];
    for (int i = 6; i >= 0; --i)
        r = r * s + kAtanTurns[i];
    r = r * a;
    r = ay > ax ? 0.25f - r : r;
    r = x < 0 ? 0.5f - r : r;
    return std::copysign(r, y);
}

} // namespace vmlight
