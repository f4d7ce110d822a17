// SPDX-License-Identifier: Apache-2.0
/// An Embree scene of triangles, which Occluder and VisibleSurface trace.
#pragma once

#include <vmlight/mesh/instances.h>
#include <vmlight/mesh/mesh.h>
#include <vmlight/trace/curves.h>
#include <vmlight/trace/cutouts.h>
#include <vmlight/trace/embree.h>
#include <vmlight/trace/occluder.h>
#include <vmlight/trace/trimmed_pieces.h>

#include <array>
#include <cmath>
#include <cstdint>
#include <deque>
#include <memory>
#include <string>
#include <vector>

namespace vmlight::embree {

/// Embree's buffers of a mesh, or of some of its triangles: the user data of its geometry. Curves have neither.
struct Buffers
{
    const Imath::V3f* vertices;
    const std::array<uint32_t, 3>* triangles;
    size_t triangle_count;
    /// Of what cut-outs the triangles are the mixed ones, or nullptr.
    const Cutouts* cutouts = nullptr;
    /// What Embree has in place of each of those: its vertices are others than `vertices`.
    std::vector<TrimmedPiece> pieces {};
    std::vector<std::array<uint32_t, 3>> whole_triangles {}; ///< what `triangles` points to, of mixed ones
    size_t mesh = 0; ///< its place among those that Scene::build() was given
    uint64_t bits = 0; ///< as those of Placements, of a copy
    bool is_mirrored = false; ///< of a copy: its winding is that before the mirror
};

/// The instances of one of the meshes of a scene.
struct PlacedMeshes
{
    size_t mesh = 0; ///< its place among those that Scene::build() is given
    const MeshInstances* instances;
    /// Of each distinct mesh, as those of Scene::build().
    std::vector<const Cutouts*> cutouts;
    InstanceMode mode = InstanceMode::many;
};

/// How far Embree's barycentric weights of a hit are off at most, robust traversal at unit directions: by the rounding
/// of the plane and edges, which grows as the triangle is small, far away and seen from the side, and by an approximate
/// reciprocal. Seven times the most that was seen, among slivers, far away and from the side.
///
/// @param distance     of the hit along the ray
/// @param normal_dot   the triangle's normal, as long as twice its area, times the direction
inline float weight_error(float distance, float longest_edge, float normal_dot)
{
    return 8e-7f * (distance + longest_edge) * longest_edge / std::fabs(normal_dot) + 8e-6f;
}

/// Embree's filter of hits on mixed triangles, of shadow rays and others: rejects those where light passes.
void reject_open_hits(const RTCFilterFunctionNArguments* arguments);

/// Add curves to a scene as geometry `id`. They must outlive it.
void attach_curves(RTCDevice device, RTCScene scene, const Curves& curves, CurveShape shape, unsigned id,
                   void* user_data, RTCFilterFunctionN occluded = nullptr);

class Scene
{
public:
    Scene();
    ~Scene();
    Scene(const Scene&) = delete;
    Scene& operator=(const Scene&) = delete;

    /// Build the scene from the triangles of all `meshes`; the geometry of each has its index as its ID. Traversal is
    /// robust. nullptr, with the reason in `error`, if Embree fails (out of memory). The strands of mesh i are flat
    /// curves, the geometry 2 meshes.size() + i.
    ///
    /// Instances of meshes follow, each a geometry. Their distinct meshes are scenes of their own.
    ///
    /// @param cutouts  of each mesh, nullptr where all of it is opaque; or none: no mesh is cut out. Must outlive the
    ///                 scene. The mixed triangles of mesh i are the geometry meshes.size() + i
    /// @param lasting  the one of `meshes` that outlives the scene and does not change meanwhile, so that its triangles
    ///                 need not be copied; nullptr: none does
    static std::unique_ptr<Scene> build(const std::vector<const Mesh*>& meshes, const SceneFrame& frame, int nthreads,
                                        std::string& error,
                                        const std::vector<std::unique_ptr<const Cutouts>>& cutouts = {},
                                        const std::vector<PlacedMeshes>& placed = {}, const Mesh* lasting = nullptr);

    RTCScene handle() const { return m_whole.scene; }
    /// Those of each geometry that is no instance.
    const std::deque<Buffers>& buffers() const { return m_whole.buffers; }
    const InstanceCounts& instances() const { return m_counts; }
    /// Of a geometry that is no instance.
    const Buffers& buffers_of(unsigned id) const
    {
        return *static_cast<const Buffers*>(rtcGetGeometryUserData(rtcGetGeometry(m_whole.scene, id)));
    }
    /// Whether a mesh has strands.
    bool has_curves() const { return !m_curves.empty(); }
    /// Where Embree's instances are.
    const Placements& placements() const { return *m_placements; }

private:
    /// Triangles: all that are none of an instance, or a distinct mesh.
    struct Part
    {
        ~Part() { release(); }
        void release();
        RTCScene scene = nullptr;
        SceneFrame frame;
        std::deque<Buffers> buffers; // Embree keeps pointers to its elements
        std::vector<RTCBuffer> vertices; // that geometries share
    };
    void start(Part& part, bool is_compact);
    bool attach_strands(const Strands& strands, unsigned id, std::string& error);
    bool attach(Part& part, const Mesh& mesh, unsigned id, bool is_lasting = false);
    bool attach_sorted(Part& part, const Mesh& mesh, const Cutouts& cutouts, unsigned id, unsigned mixed_id);
    bool attach_opaque(Part& part, RTCBuffer vertices, const Mesh& mesh, const Cutouts& cutouts, unsigned id);
    bool attach_mixed(Part& part, const Imath::V3f* vertices, const Mesh& mesh, const Cutouts& cutouts, unsigned id);
    bool attach_placed(const std::vector<PlacedMeshes>& placed, unsigned next_id, std::string& error);
    bool attach_copy(const PlacedMeshes& placed, size_t place, unsigned& next_id);
    void attach_instance(const Part& distinct, const InstanceTransform& transform, unsigned id);

    RTCDevice m_device = nullptr;
    Part m_whole;
    std::deque<Curves> m_curves; // Embree keeps pointers to its elements
    Buffers m_no_triangles { nullptr, nullptr, 0 }; // of all curves
    std::vector<std::unique_ptr<Part>> m_distinct;
    std::unique_ptr<Placements> m_placements;
    InstanceCounts m_counts;
};

/// Set all of a lane of RTCRay8 but its origin, direction and length.
inline void prepare_lane(RTCRay8& rays, int lane)
{
    rays.tnear[lane] = 0;
    rays.time[lane] = 0;
    rays.mask[lane] = ~0u;
    rays.id[lane] = unsigned(lane);
    rays.flags[lane] = 0;
}

} // namespace vmlight::embree
