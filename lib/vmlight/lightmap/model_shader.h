// SPDX-License-Identifier: Apache-2.0
/// What every shading model implements: texels of a visibility map in, colour out.
///
/// A model's inner loop comes in up to two forms: a vector one, compiled for several instruction sets and chosen when
/// it first runs, and a scalar one, which defines it. Both round alike at each step (no fused multiply-add), so that
/// the results are the same bits on every machine with IEEE division and square root.
#pragma once

#include <vmlight/math/rotation.h>

#include <OpenImageIO/imagebuf.h>

#include <cstddef>
#include <memory>
#include <string>
#include <vector>

namespace vmlight {

/// Where V is among the first four floats of a texel; x, y, z of B keep their order. V comes last in an EXR whose
/// channels were sorted by name. Models that read more than V and B always get V first.
enum class TexelLayout
{
    visibility_first,
    visibility_last
};

/// What all models share.
struct ShadeSetup
{
    /// Object space to environment space, row major.
    float rotation[9];
    /// Multiplies the result. Finite, not negative.
    float gain;
};

/// Models that look up narrower light than a cosine's are held to this many times the brightest point of the CFEM. Just
/// above 1, so that rounding is not.
constexpr float kAboveRounding = 1.00001f;

/// The largest |V| that is accepted. Filters that ring exceed [0, 1] a little; beyond this the map was graded, or it is
/// another picture.
constexpr float kLargestVisibility = 2;

/// One model with its light prepared, at one rotation.
class ModelShader
{
public:
    virtual ~ModelShader() = default;

    /// Shade a run of texels. Any thread.
    ///
    /// @param vismap   the floats of the model's channels (ShadingModel::channels), texel by texel
    /// @param rgb      set to three floats per texel; must not overlap `vismap`
    /// @returns false if an input may not have been finite, |V| may be above kLargestVisibility, a number that must be
    ///          whole is not, or a result may be out of float's range: the caller finds out which. Never reads or
    ///          writes outside its arrays, whatever the input.
    virtual bool shade(TexelLayout layout, const float* vismap, size_t texels, float* rgb) const = 0;
};

/// What a model's light is prepared from.
struct ModelInput
{
    /// The images that ModelEntry::light asks for.
    OIIO::cspan<OIIO::ImageBuf> light;
    /// Turns directions from object space to environment space; ShadeSetup::rotation in double.
    const Rotation& to_environment;
    ShadeSetup setup;
    /// Floats of a texel.
    int channels;
};

} // namespace vmlight
