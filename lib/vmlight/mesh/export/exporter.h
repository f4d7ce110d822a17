// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vmlight/mesh/export/write_mesh.h>
#include <vmlight/mesh/strands.h>

#include <string>
#include <vector>

namespace vmlight {

/// A file, whole.
struct MeshFile
{
    std::string path, bytes;
};

/// One entry of the table of formats.
struct MeshWriter
{
    const char* extension;
    /// The files of a mesh, the one called `path` last.
    std::vector<MeshFile> (*write)(const Mesh& mesh, const std::string& path);
    /// The same of strands, each a polyline whose points have `uvs`.
    std::vector<MeshFile> (*write_strands)(const Strands& strands, const std::vector<Imath::V2f>& uvs,
                                           const std::string& path);
};

std::vector<MeshFile> obj_files(const Mesh& mesh, const std::string& path);
std::vector<MeshFile> gltf_files(const Mesh& mesh, const std::string& path);
std::vector<MeshFile> obj_strand_files(const Strands& strands, const std::vector<Imath::V2f>& uvs,
                                       const std::string& path);
std::vector<MeshFile> gltf_strand_files(const Strands& strands, const std::vector<Imath::V2f>& uvs,
                                        const std::string& path);

} // namespace vmlight
