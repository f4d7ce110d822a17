// SPDX-License-Identifier: Apache-2.0
/// What maps of one mesh share: the mesh, and the ray tracer's scene of it and of what casts on it.
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

/// Built once, then baked from by any number of bakers: neither UDIM tile nor resolution, samples or seed matter to it.
class BakeScene
{
public:
    /// @param mesh     kept; `occluders` are not
    /// @returns false, with the reason in `error`, if the mesh has no triangle or no uvs, one of the meshes fails
    ///          check_mesh() or reaches farther than the ray tracer does, or memory runs out
    bool build(std::shared_ptr<const Mesh> mesh, const std::vector<Mesh>& occluders, int nthreads, std::string& error);

    // After build().
    const Mesh& mesh() const { return *m_mesh; }
    const SceneFrame& frame() const { return m_frame; }
    const Occluder& occluder() const { return m_occluder; }
    /// mesh_hash() of the mesh, and of each occluder, parted by commas.
    const std::string& mesh_hash() const { return m_mesh_hash; }
    const std::string& occluder_hashes() const { return m_occluder_hashes; }
    /// Triangles of the mesh and of all occluders.
    int64_t triangles() const { return m_triangles; }
    /// Triangles of the mesh that are smaller than kTinyTriangle.
    int64_t tiny() const { return m_tiny; }
    /// As VismapReport::rounding.
    double rounding() const { return m_rounding; }
    /// Memory held, about.
    size_t bytes() const;

    /// What the caller read to build it, kept here for those who share it.
    std::vector<FileStamp> files;

private:
    std::shared_ptr<const Mesh> m_mesh;
    SceneFrame m_frame;
    Occluder m_occluder;
    std::string m_mesh_hash, m_occluder_hashes;
    int64_t m_triangles = 0, m_tiny = 0;
    double m_rounding = 0;
};

/// A pointer to `mesh`, which must outlive what takes it.
inline std::shared_ptr<const Mesh> borrowed(const Mesh& mesh)
{
    return std::shared_ptr<const Mesh>(std::shared_ptr<const Mesh>(), &mesh);
}

using BakeScenePointer = std::shared_ptr<const BakeScene>;

} // namespace vmlight
