// SPDX-License-Identifier: Apache-2.0
/// The model `lobe`: one lookup in a stack of lobes. gain V C_r(R B / |B|), r = |B| / V, where C_r is the environment
/// filtered with the lobe whose mean direction has length r (lobe_lookup.h), linear in r between the knots of the
/// stack. 0 where V <= 0. Maps of strands have a lobe of their own (model_strand_lobe.h).
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

/// V and B, and of strands their tangents.
std::vector<std::string> lobe_model_channels(const OIIO::ImageSpec& vismap);
std::unique_ptr<ModelShader> prepare_lobe(const ModelInput& input, std::string& error);

} // namespace vmlight
