// SPDX-License-Identifier: Apache-2.0
/// The ray-tracing scene of a bake: the baked mesh and its occluders.
#pragma once

#include <vmlight/base/file_stamp.h>
#include <vmlight/base/progress.h>
#include <vmlight/mesh/mesh.h>
#include <vmlight/trace/caster_reach.h>
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
    /// @param choice   what of them is traced. With the default, occluders that no ray can meet are left out
    /// @param at_step  hears of steps by their names
    bool build(std::shared_ptr<const Mesh> mesh, const std::vector<Mesh>& occluders, int nthreads, std::string& error,
               const SceneChoice& choice = {}, const StepListener& at_step = {});

    /// A scene that bakes `part` of the mesh of `whole`, which is kept alive: all of `whole` occludes, in the same
    /// frame, so that the part's texels get the same bits as those of the whole mesh.
    /// @param rest     the other triangles, for occluder_hashes()
    /// @returns as for build()
    bool build_part(std::shared_ptr<const BakeScene> whole, std::shared_ptr<const Mesh> part, const Mesh& rest,
                    std::string& error);

    // After build().
    const Mesh& mesh() const { return *m_mesh; }
    const SceneFrame& frame() const { return m_frame; }
    const Occluder& occluder() const { return *m_occluder; }
    /// The mesh of which this bakes a part; or mesh(). It alone has the numbers of triangles that occluder() knows.
    const Mesh& whole() const { return m_whole ? m_whole->whole() : *m_mesh; }
    /// Which meshes occluder() traces, by their numbers there: kWhole, or the index of an occluder.
    static constexpr int kWhole = -1;
    const std::vector<int>& casters() const { return m_whole ? m_whole->casters() : m_casters; }
    /// mesh_hash() of the mesh, and of each occluder, separated by commas.
    const std::string& mesh_hash() const { return m_mesh_hash; }
    /// mesh_shape() of the mesh.
    const std::string& mesh_shape() const { return m_mesh_shape; }
    const std::string& occluder_hashes() const { return m_occluder_hashes; }
    /// Mesh::name of each occluder given, or "unnamed", separated by ", ".
    const std::string& occluder_names() const { return m_occluder_names; }
    /// opacity_hash() of all meshes, separated by commas; of a part, those of the whole.
    const std::string& opacity_hashes() const { return m_opacity_hashes; }
    /// Triangles of the mesh and all occluders, those of instances once; and spans of strands among them.
    int64_t triangle_count() const { return m_triangles; }
    int64_t span_count() const { return m_spans; }
    /// Triangles of the mesh that are smaller than kTinyTriangle.
    int64_t tiny_triangles() const { return m_tiny; }
    /// See VismapReport::rounding.
    double rounding() const { return m_rounding; }
    /// Mesh::warnings of the mesh and its occluders, after their paths.
    const std::vector<std::string>& warnings() const { return m_warnings; }
    /// What is traced of the meshes given, and each occluder with the reason; SceneChoice::own_parts are among them.
    const SceneChoice& choice() const { return m_choice; }
    const std::vector<CasterReach>& reach() const { return m_reach; }
    /// An occluder that is left out because no ray of a texel can meet it, or nullptr. It may shade what texels see.
    const CasterReach* culled_occluder() const;
    /// Of the box around the mesh and its occluders, in mesh units.
    double diagonal() const { return m_diagonal; }
    /// Least y of the whole mesh, in mesh units.
    double lowest() const { return m_lowest; }
    /// Approximate memory use.
    size_t bytes() const;

    /// As if the mesh were part of one whose least y is this.
    void set_lowest(double y) { m_lowest = y; }

    /// The files that the caller read to build the scene, for those who share it.
    std::vector<FileStamp> files;
    /// What the caller did to the mesh before, for the user, one sentence each.
    std::vector<std::string> remarks;

private:
    void measure();
    bool trace(const std::vector<Mesh>& occluders, int nthreads, std::string& error, const StepListener& at_step);

    std::shared_ptr<const Mesh> m_mesh;
    std::shared_ptr<const BakeScene> m_whole; // of which this is a part, or nullptr
    SceneFrame m_frame;
    std::shared_ptr<const Occluder> m_occluder;
    std::string m_mesh_hash, m_mesh_shape, m_occluder_hashes, m_occluder_names, m_opacity_hashes;
    std::vector<std::string> m_warnings;
    int64_t m_triangles = 0, m_spans = 0, m_tiny = 0;
    double m_rounding = 0, m_lowest = 0, m_diagonal = 0;
    SceneChoice m_choice;
    std::vector<int> m_casters;
    std::vector<CasterReach> m_reach;
};

/// Embree silently ignores geometry farther away than 1.8e18.
constexpr double kFarthestCaster = 1e18;

/// False, with the reason in `error`, if a vertex or a strand's point of `mesh` is too far away to be traced in this
/// frame.
bool check_reach(const Mesh& mesh, const SceneFrame& frame, std::string& error);

/// A non-owning pointer to `mesh`, which must outlive it.
inline std::shared_ptr<const Mesh> non_owning(const Mesh& mesh)
{
    return std::shared_ptr<const Mesh>(std::shared_ptr<const Mesh>(), &mesh);
}

using BakeScenePointer = std::shared_ptr<const BakeScene>;

} // namespace vmlight
