// SPDX-License-Identifier: Apache-2.0
/// An Embree scene of triangles, which Occluder and VisibleSurface trace.
#pragma once

#include <vmlight/mesh/mesh.h>
#include <vmlight/trace/curves.h>
#include <vmlight/trace/cutouts.h>
#include <vmlight/trace/embree.h>
#include <vmlight/trace/occluder.h>

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
    /// The longest edge of each of those.
    std::vector<float> longest_edges {};
    size_t mesh = 0; ///< its place among those that Scene::build() was given
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
    Scene() = default;
    ~Scene();
    Scene(const Scene&) = delete;
    Scene& operator=(const Scene&) = delete;

    /// Build the scene from the triangles of all `meshes`; the geometry of each has its index as its ID. Traversal is
    /// robust. nullptr, with the reason in `error`, if Embree fails (out of memory). The strands of mesh i are flat
    /// curves, the geometry 2 meshes.size() + i.
    ///
    /// @param cutouts  of each mesh, nullptr where all of it is opaque; or none: no mesh is cut out. Must outlive the
    ///                 scene. The mixed triangles of mesh i are the geometry meshes.size() + i
    static std::unique_ptr<Scene> build(const std::vector<const Mesh*>& meshes, const SceneFrame& frame, int nthreads,
                                        std::string& error,
                                        const std::vector<std::unique_ptr<const Cutouts>>& cutouts = {});

    RTCScene handle() const { return m_scene; }
    /// Those of each geometry.
    const std::deque<Buffers>& buffers() const { return m_buffers; }
    /// Whether a mesh has strands.
    bool has_curves() const { return !m_curves.empty(); }

private:
    bool attach_strands(const Strands& strands, const SceneFrame& frame, unsigned id, std::string& error);
    bool attach(const Mesh& mesh, const SceneFrame& frame, unsigned id);
    bool attach_sorted(const Mesh& mesh, const Cutouts& cutouts, const SceneFrame& frame, unsigned id,
                       unsigned mixed_id);
    bool attach_part(RTCBuffer vertices, const Mesh& mesh, const std::vector<uint32_t>& part, const Cutouts* cutouts,
                     unsigned id);

    RTCDevice m_device = nullptr;
    RTCScene m_scene = nullptr;
    std::deque<Buffers> m_buffers; // Embree keeps pointers to elements of both
    std::deque<Curves> m_curves;
    Buffers m_no_triangles { nullptr, nullptr, 0 }; // of all curves
};

/// Set all of a lane of RTCRay8 but its origin, direction and length.
inline void prepare_lane(RTCRay8& rays, int lane)
{
    rays.tnear[lane] = 0;
    rays.time[lane] = 0;
    rays.mask[lane] = ~0u;
    rays.id[lane] = 0;
    rays.flags[lane] = 0;
}

} // namespace vmlight::embree
