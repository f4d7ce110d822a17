// SPDX-License-Identifier: Apache-2.0
#include <vmlight/trace/strand_scene.h>

#include <vmlight/base/format.h>
#include <vmlight/base/process_exit.h>
#include <vmlight/mesh/instances.h>
#include <vmlight/trace/bake_scene.h>
#include <vmlight/trace/curves.h>
#include <vmlight/trace/embree_scene.h>
#include <vmlight/trace/fan_query.h>

#include <algorithm>
#include <limits>

namespace vmlight {
namespace {

using Imath::V3d;
using Imath::V3f;

// Embree's filter of hits: rays pass the strand that they start in.
void pass_own_strand(const RTCFilterFunctionNArguments* arguments)
{
    const auto* const strand_of = static_cast<const uint32_t*>(arguments->geometryUserPtr);
    const uint32_t own = static_cast<embree::QueryContext*>(arguments->context)->own_strand;
    const unsigned n = arguments->N;
    for (unsigned lanes = embree::valid_lanes(arguments->valid, n); lanes; lanes &= lanes - 1) {
        const unsigned i = embree::first_lane(lanes);
        if (strand_of[RTCHitN_primID(arguments->hit, n, i)] == own)
            arguments->valid[i] = 0;
    }
}

} // namespace

class StrandScene::Rounds
{
public:
    Rounds() = default;
    ~Rounds()
    {
        if (is_process_exiting()) // see embree::Scene
            return;
        if (m_scene)
            rtcReleaseScene(m_scene);
        if (m_device)
            rtcReleaseDevice(m_device);
    }
    Rounds(const Rounds&) = delete;
    Rounds& operator=(const Rounds&) = delete;

    bool build(int nthreads)
    {
        const std::string threads = nthreads > 0 ? format("threads={},", nthreads) : "";
        m_device = rtcNewDevice((threads + "set_affinity=0").c_str());
        if (!m_device)
            return false;
        m_scene = rtcNewScene(m_device);
        rtcSetSceneFlags(m_scene, RTC_SCENE_FLAG_ROBUST);
        embree::attach_curves(m_device, m_scene, curves, CurveShape::round, 0,
                              const_cast<uint32_t*>(curves.strand_of().data()), pass_own_strand);
        rtcCommitScene(m_scene);
        return rtcGetDeviceError(m_device) == RTC_ERROR_NONE;
    }

    RTCScene handle() const { return m_scene; }

    Curves curves; // Embree keeps pointers into it

private:
    RTCDevice m_device = nullptr;
    RTCScene m_scene = nullptr;
};

StrandScene::StrandScene() = default;
StrandScene::~StrandScene() = default;

bool StrandScene::build(const Strands& strands, const std::vector<Mesh>& occluders, int nthreads, std::string& error,
                        const StepListener& at_step)
{
    V3d low(std::numeric_limits<double>::infinity()), high(-std::numeric_limits<double>::infinity());
    for (const V3d& p : strands.points)
        for (int axis = 0; axis < 3; ++axis) {
            low[axis] = std::min(low[axis], p[axis]);
            high[axis] = std::max(high[axis], p[axis]);
        }
    m_frame = SceneFrame::around(low, high);
    m_rounds = std::make_unique<Rounds>();
    Curves& curves = m_rounds->curves;
    if (!curves.add(strands, m_frame, CurveShape::round, 0, error))
        return false;
    m_spans = int64_t(curves.spans().size());
    std::vector<const Mesh*> casters;
    for (const Mesh& occluder : occluders) {
        if (!check_mesh(occluder, error) || !check_instances(occluder, error) || !check_reach(occluder, m_frame, error)
            || (occluder.strands
                && !curves.add(*occluder.strands, m_frame, CurveShape::round, Curves::kNoOwner, error)))
            return false;
        if (held_triangles(occluder) > 0)
            casters.push_back(&occluder);
        m_triangles += held_triangles(occluder);
    }
    m_has_meshes = !casters.empty();
    begin_step(at_step, "build");
    if (!m_rounds->build(nthreads)) {
        error = "Embree cannot build the ray-tracing scene: out of memory, or the CPU is not supported";
        return false;
    }
    return !m_has_meshes || m_meshes.build(casters, m_frame, nthreads, error, CutoutMode::micromaps, at_step);
}

size_t StrandScene::bytes() const
{
    return size_t(kBytesOfSpan) * m_rounds->curves.spans().size() + 80 * size_t(m_triangles); // as BakeScene::bytes()
}

void StrandScene::clear_blocked(RayFan& fan, const V3f& origin, float radius, uint32_t own, float length) const
{
    if (m_has_meshes)
        m_meshes.clear_blocked(fan, origin, length);
    if (!(radius < length))
        return;
    const embree::FlushDenormals flush;
    embree::Query query;
    query.pass_strand(own);
    embree::clear_blocked(fan, query, m_rounds->handle(), origin, radius, length);
}

} // namespace vmlight
