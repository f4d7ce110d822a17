// SPDX-License-Identifier: Apache-2.0
/// The model `lobe`: one lookup in a stack of lobes. gain V C_r(R B / |B|), r = |B| / V, where C_r is the environment
/// filtered with the lobe whose mean direction has length r (lobe_lookup.h), linear in r between the knots of the
/// stack. 0 where V <= 0.
#pragma once

#include <vmlight/lightmap/lobe_lookup.h>
#include <vmlight/lightmap/model_shader.h>

namespace vmlight {

/// ModelShader::shade(), four floats per texel.
bool shade_lobe(const LobeLookup& lobes, const ShadeSetup& setup, TexelLayout layout, const float* vismap,
                size_t texels, float* rgb);
/// The same, one texel at a time.
bool shade_lobe_scalar(const LobeLookup& lobes, const ShadeSetup& setup, TexelLayout layout, const float* vismap,
                       size_t texels, float* rgb);

std::unique_ptr<ModelShader> prepare_lobe(const ModelInput& input, std::string& error);

} // namespace vmlight
