// SPDX-License-Identifier: Apache-2.0
/// The model `mask`: light within the visible range of heights of each of 16 columns of longitude (cell_sums.h).
#pragma once

#include <vmlight/lightmap/cell_light.h>
#include <vmlight/lightmap/model_shader.h>
#include <vmlight/math/packed_visibility.h>

namespace vmlight {

/// Shade a run of texels, as ModelShader::shade(), with the vectors of the machine or one by one: the same bits.
bool shade_mask(const CellLight& light, const ShadeSetup& setup, const float* vismap, size_t texels, float* rgb);
bool shade_mask_scalar(const CellLight& light, const ShadeSetup& setup, const float* vismap, size_t texels, float* rgb);

std::vector<std::string> mask_model_channels(const OIIO::ImageSpec& vismap);
bool has_mask(const OIIO::ImageSpec& vismap);
std::unique_ptr<ModelShader> prepare_mask(const ModelInput& input, std::string& error);

} // namespace vmlight
