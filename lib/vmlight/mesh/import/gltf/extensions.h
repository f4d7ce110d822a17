// SPDX-License-Identifier: Apache-2.0
/// What is done with each glTF extension.
#pragma once

#include <vmlight/mesh/import/mesh_builder.h>

#include <string>
#include <vector>

namespace vmlight::gltf {

/// Throws Error if a required extension is not known, naming it; warns of each unknown one that is merely used, since
/// it may change the geometry.
void check_extensions(const std::vector<std::string>& used, const std::vector<std::string>& required,
                      MeshBuilder& builder);

} // namespace vmlight::gltf
