// SPDX-License-Identifier: Apache-2.0
/// Light of one colour: whatever the model, and wherever a texel looks, it is V times that colour.
#pragma once

#include <vmlight/lightmap/model.h>
#include <vmlight/lightmap/model_shader.h>

#include <array>
#include <memory>

namespace vmlight {

/// gain V color, and as the model has it: 0 where V <= 0; not above gain times `color` (kAboveRounding), if it is held
/// to the brightest light. Checks what the model would.
///
/// @param forced   nullptr, or what the model makes of the light with all its lookups, which is worked out and not used
std::unique_ptr<ModelShader> one_color_shader(const std::array<float, 3>& color, const ShadingModel& model, float gain,
                                              std::unique_ptr<ModelShader> forced);

} // namespace vmlight
