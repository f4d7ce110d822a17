// SPDX-License-Identifier: Apache-2.0
/// The sums of the model `sh`: a texel's numbers times the light's, for each colour.
#pragma once

#include <vmlight/lightmap/model_shader.h>

#include <cstddef>
#include <vector>

namespace vmlight {

/// The environment as spherical harmonics, at one rotation.
struct HarmonicLight
{
    /// Bands squared.
    int count = 0;
    /// R, G, B and a 0 for each number of a texel. V and B are the first two bands up to constants, which are
    /// multiplied in here.
    std::vector<float> coefficients;
    /// From find_brightest_light().
    float brightest[3] = { 0, 0, 0 };
};

/// ModelShader::shade() of `sh`, for texels of `light.count` floats, V first.
bool shade_harmonics(const HarmonicLight& light, const ShadeSetup& setup, const float* vismap, size_t texels,
                     float* rgb);
/// The same, one texel at a time: what the vector form must equal to the bit.
bool shade_harmonics_scalar(const HarmonicLight& light, const ShadeSetup& setup, const float* vismap, size_t texels,
                            float* rgb);

} // namespace vmlight
