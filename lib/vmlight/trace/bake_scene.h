// SPDX-License-Identifier: Apache-2.0
/// The ray-tracing scene of a bake: the baked mesh and its occluders.
#pragma once

#include <vmlight/base/file_stamp.h>
#include <vmlight/mesh/mesh.h>
#include <vmlight/trace/occluder.h>

#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

namespace vmlight {

/// Built once and shared by all maps of a mesh, whatever their UDIM tile, resolution, samples and seed. Thread-safe
/// after build().
class BakeScene
{
public:
    /// @param mesh     kept alive; `occluders` are not
    /// @returns false, with the reason in `error`, if the mesh has no triangles or no uvs, a mesh fails check_mesh() or
    ///          is too far away to be traced, or memory runs out
    bool build(std::shared_ptr<const Mesh> mesh, const std::vector<Mesh>& occluders, int nthreads, std::string& error);

    // After build().
    const Mesh& mesh() const { return *m_mesh; }
    const SceneFrame& frame() const { return m_frame; }
    const Occluder& occluder() const { return m_occluder; }
    /// mesh_hash() of the mesh, and of each occluder, separated by commas.
    const std::string& mesh_hash() const { return m_mesh_hash; }
    const std::string& occluder_hashes() const { return m_occluder_hashes; }
    /// Triangles of the mesh and all occluders.
    int64_t triangle_count() const { return m_triangles; }
    /// Triangles of the mesh that are smaller than kTinyTriangle.
    int64_t tiny_triangles() const { return m_tiny; }
    /// See VismapReport::rounding.
    double rounding() const { return m_rounding; }
    /// Approximate memory use.
    size_t bytes() const;

    /// The files that the caller read to build the scene, for those who share it.
    std::vector<FileStamp> files;
    /// What the caller did to the mesh before, and what may surprise about it, one sentence each.
    std::vector<std::string> remarks, warnings;

private:
    std::shared_ptr<const Mesh> m_mesh;
    SceneFrame m_frame;
    Occluder m_occluder;
    std::string m_mesh_hash, m_occluder_hashes;
    int64_t m_triangles = 0, m_tiny = 0;
    double m_rounding = 0;
};

/// A non-owning pointer to `mesh`, which must outlive it.
inline std::shared_ptr<const Mesh> non_owning(const Mesh& mesh)
{
    return std::shared_ptr<const Mesh>(std::shared_ptr<const Mesh>(), &mesh);
}

using BakeScenePointer = std::shared_ptr<const BakeScene>;

} // namespace vmlight
