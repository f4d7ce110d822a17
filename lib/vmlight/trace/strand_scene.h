// SPDX-License-Identifier: Apache-2.0
/// The ray-tracing scene of strands: round curves, and the meshes around them.
#pragma once

#include <vmlight/base/progress.h>
#include <vmlight/math/ray_fan.h>
#include <vmlight/mesh/mesh.h>
#include <vmlight/mesh/strands.h>
#include <vmlight/trace/occluder.h>

#include <Imath/ImathVec.h>

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

namespace vmlight {

/// Built once, then traced from any number of threads.
class StrandScene
{
public:
    StrandScene();
    ~StrandScene();
    StrandScene(const StrandScene&) = delete;
    StrandScene& operator=(const StrandScene&) = delete;

    /// Strands are traced as StrandCurve has them, their spans cut to at most 2000 radii, beyond which Embree loses
    /// their width.
    ///
    /// @param strands  must have passed check_strands(); not kept
    /// @param occluders are not kept; other strands among them are traced round, too
    /// @returns false, with the reason in `error`, if an occluder fails check_mesh() or is too far away to be traced, a
    ///          strand is so thin that it would be cut into more than 65536 spans, or memory runs out
    bool build(const Strands& strands, const std::vector<Mesh>& occluders, int nthreads, std::string& error,
               const StepListener& at_step = {});

    /// After build(): fits the strands.
    const SceneFrame& frame() const { return m_frame; }
    /// Spans of the strands' curves.
    int64_t span_count() const { return m_spans; }
    /// Approximate memory use.
    size_t bytes() const;

    /// Clear the bit of each ray that a mesh, or a strand other than `own`, blocks within `length`, in scene units.
    /// @param origin   on the axis of `own`, which is `radius` thick there; strands are met from there on
    void clear_blocked(RayFan& fan, const Imath::V3f& origin, float radius, uint32_t own, float length) const;

private:
    class Rounds;
    SceneFrame m_frame;
    std::unique_ptr<Rounds> m_rounds;
    Occluder m_meshes;
    bool m_has_meshes = false;
    int64_t m_spans = 0, m_triangles = 0;
};

} // namespace vmlight
