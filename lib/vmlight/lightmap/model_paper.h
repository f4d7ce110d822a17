// SPDX-License-Identifier: Apache-2.0
/// The models `paper` and `ao`: one lookup in the CFEM.
/// `paper` is gain V C(R B / |B|); `ao` is gain V C(R n), the same code with the normal in the direction's place. 0
/// where V <= 0. Where V > 0 but B gives no direction (kNoDirection), C is the mean of the CFEM over the sphere.
/// Source: I. Neulander, "Image-Based Diffuse Lighting Using Visibility Maps", section 4.
#pragma once

#include <vmlight/lightmap/cfem_lookup.h>
#include <vmlight/lightmap/model_shader.h>

namespace vmlight {

/// ModelShader::shade(), four floats per texel.
bool shade_paper(const CfemLookup& cfem, const ShadeSetup& setup, TexelLayout layout, const float* vismap,
                 size_t texels, float* rgb);
/// The same, one texel at a time.
bool shade_paper_scalar(const CfemLookup& cfem, const ShadeSetup& setup, TexelLayout layout, const float* vismap,
                        size_t texels, float* rgb);

std::vector<std::string> paper_model_channels(const OIIO::ImageSpec& vismap);
std::vector<std::string> ao_model_channels(const OIIO::ImageSpec& vismap);
std::unique_ptr<ModelShader> prepare_paper(const ModelInput& input, std::string& error);

} // namespace vmlight
