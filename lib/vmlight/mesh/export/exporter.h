// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vmlight/mesh/export/write_mesh.h>

#include <string>
#include <vector>

namespace vmlight {

/// One entry of the table of formats.
struct MeshWriter
{
    const char* extension;
    std::vector<MeshFile> (*write)(const Mesh& mesh, const std::string& path);
};

std::vector<MeshFile> obj_files(const Mesh& mesh, const std::string& path);
std::vector<MeshFile> gltf_files(const Mesh& mesh, const std::string& path);

} // namespace vmlight
