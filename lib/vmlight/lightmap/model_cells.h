// SPDX-License-Identifier: Apache-2.0
/// The model `cells`: light of each of 144 cells of the sphere, weighted by how much of it is visible (cell_sums.h).
#pragma once

#include <vmlight/lightmap/cell_light.h>
#include <vmlight/lightmap/model_shader.h>
#include <vmlight/math/packed_visibility.h>

namespace vmlight {

/// Shade a run of texels, as ModelShader::shade(), with the vectors of the machine or one by one: the same bits.
bool shade_cells(const CellLight& light, const ShadeSetup& setup, const float* vismap, size_t texels, float* rgb);
bool shade_cells_scalar(const CellLight& light, const ShadeSetup& setup, const float* vismap, size_t texels,
                        float* rgb);

std::vector<std::string> cells_model_channels(const OIIO::ImageSpec& vismap);
bool has_cells(const OIIO::ImageSpec& vismap);
std::unique_ptr<ModelShader> prepare_cells(const ModelInput& input, std::string& error);

} // namespace vmlight
