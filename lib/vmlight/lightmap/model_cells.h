// SPDX-License-Identifier: Apache-2.0
/// The model `cells`: light of each of 144 cells of the sphere, weighted by how much of it is visible (cell_sums.h).
#pragma once

#include <vmlight/lightmap/model_shader.h>
#include <vmlight/math/packed_visibility.h>

namespace vmlight {

std::vector<std::string> cells_model_channels(const OIIO::ImageSpec& vismap);
bool has_cells(const OIIO::ImageSpec& vismap);
std::unique_ptr<ModelShader> prepare_cells(const ModelInput& input, std::string& error);

} // namespace vmlight
