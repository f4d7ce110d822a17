// SPDX-License-Identifier: Apache-2.0
#include <vmlight/trace/strand_scene.h>

#include <vmlight/base/available_memory.h>
#include <vmlight/base/format.h>
#include <vmlight/mesh/instances.h>
#include <vmlight/mesh/strand_curve.h>
#include <vmlight/trace/bake_scene.h>
#include <vmlight/trace/embree_scene.h>
#include <vmlight/trace/fan_query.h>

#include <algorithm>
#include <array>
#include <limits>

namespace vmlight {
namespace {

using Imath::V3d;
using Imath::V3f;

// Embree's round curves keep their width up to about 6000 radii a span.
constexpr double kLongestSpan = 2000;
constexpr size_t kMostSpans = 65536;
// Measured: what Embree needs for a span of a round B-spline.
constexpr double kBytesOfSpan = 160;

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

class StrandScene::Curves
{
public:
    Curves() = default;
    ~Curves()
    {
        if (m_scene)
            rtcReleaseScene(m_scene);
        if (m_device)
            rtcReleaseDevice(m_device);
    }
    Curves(const Curves&) = delete;
    Curves& operator=(const Curves&) = delete;

    bool append(const Strands& strands, size_t strand, const SceneFrame& frame, double available, std::string& error)
    {
        StrandCurve curve(strands, strand);
        if (!curve.cut(kLongestSpan, kMostSpans)) {
            error = format("\"{}\": strand {} is more than {} times as long as it is thick: rays would miss it",
                           strands.path, strand, int64_t(kLongestSpan) * int64_t(kMostSpans));
            return false;
        }
        const auto& controls = curve.controls();
        for (size_t k = 0; k + 3 < controls.size(); ++k) {
            m_indices.push_back(uint32_t(m_controls.size() + k));
            m_strand_of.push_back(uint32_t(strand));
        }
        for (const StrandCurve::Control& control : controls) {
            const V3f p = frame.to_scene(control.position);
            m_controls.push_back({ p.x, p.y, p.z, float(control.radius * frame.scale) });
        }
        const double bytes = kBytesOfSpan * double(m_indices.size());
        if (m_controls.size() <= UINT32_MAX && bytes < available)
            return true;
        error = format("\"{}\": out of memory: up to strand {} alone, curves need {:.3g} GB", strands.path, strand,
                       bytes * 1e-9);
        return false;
    }

    bool build(int nthreads)
    {
        const std::string threads = nthreads > 0 ? format("threads={},", nthreads) : "";
        m_device = rtcNewDevice((threads + "set_affinity=0").c_str());
        if (!m_device)
            return false;
        m_scene = rtcNewScene(m_device);
        rtcSetSceneFlags(m_scene, RTC_SCENE_FLAG_ROBUST);
        RTCGeometry geometry = rtcNewGeometry(m_device, RTC_GEOMETRY_TYPE_ROUND_BSPLINE_CURVE);
        rtcSetSharedGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT4, m_controls.data(), 0,
                                   sizeof(m_controls[0]), m_controls.size());
        rtcSetSharedGeometryBuffer(geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT, m_indices.data(), 0,
                                   sizeof(m_indices[0]), m_indices.size());
        rtcSetGeometryUserData(geometry, m_strand_of.data());
        rtcSetGeometryOccludedFilterFunction(geometry, pass_own_strand);
        rtcCommitGeometry(geometry);
        rtcAttachGeometryByID(m_scene, geometry, 0);
        rtcReleaseGeometry(geometry);
        rtcCommitScene(m_scene);
        return rtcGetDeviceError(m_device) == RTC_ERROR_NONE;
    }

    RTCScene handle() const { return m_scene; }
    size_t spans() const { return m_indices.size(); }

private:
    RTCDevice m_device = nullptr;
    RTCScene m_scene = nullptr;
    std::vector<std::array<float, 4>> m_controls; // Embree keeps pointers to these three
    std::vector<uint32_t> m_indices, m_strand_of;
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
    std::vector<const Mesh*> casters;
    for (const Mesh& occluder : occluders) {
        if (!check_mesh(occluder, error) || !check_instances(occluder, error) || !check_reach(occluder, m_frame, error))
            return false;
        casters.push_back(&occluder);
        m_triangles += held_triangles(occluder);
    }
    m_has_meshes = !casters.empty();
    begin_step(at_step, "build");
    m_curves = std::make_unique<Curves>();
    const double available = double(available_memory()); // reads files of the system
    for (size_t strand = 0; strand < strands.count(); ++strand)
        if (!m_curves->append(strands, strand, m_frame, available, error))
            return false;
    m_spans = int64_t(m_curves->spans());
    if (!m_curves->build(nthreads)) {
        error = "Embree cannot build the ray-tracing scene: out of memory, or the CPU is not supported";
        return false;
    }
    return !m_has_meshes || m_meshes.build(casters, m_frame, nthreads, error, CutoutMode::micromaps, at_step);
}

size_t StrandScene::bytes() const
{
    return size_t(kBytesOfSpan) * size_t(m_spans) + 100 * size_t(m_triangles); // as BakeScene::bytes()
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
    embree::clear_blocked(fan, query, m_curves->handle(), origin, radius, length);
}

} // namespace vmlight
