// SPDX-License-Identifier: Apache-2.0
/// The only header that includes Embree, and the differences of versions 3 and 4.
#pragma once

#if __has_include(<embree4/rtcore.h>)
#include <embree4/rtcore.h>
#else
#include <embree3/rtcore.h>
#endif

#include <Imath/ImathVec.h>
#include <vmlight/trace/cutouts.h>

#include <cstdint>

#if defined(__SSE__)
#include <xmmintrin.h>
#endif

namespace vmlight::embree {

/// Of a query whose rays pass no strand.
constexpr uint32_t kNoStrand = ~0u;

class Placements;
struct Buffers;

/// A triangle that a ray met.
struct MetTriangle
{
    const Buffers* buffers = nullptr; ///< nullptr: none
    unsigned number = 0;
};

/// The rays of a packet as they are asked, in the scene. Within an instance Embree's own are in the space of its mesh;
/// their `id` is the place here.
struct SceneRays
{
    const Placements* placements = nullptr;
    Imath::V3f origins[8], directions[8];
};

#if RTC_VERSION_MAJOR >= 4
/// Required by a scene whose queries have a filter.
constexpr RTCSceneFlags kFilteredByQuery = RTC_SCENE_FLAG_FILTER_FUNCTION_IN_ARGUMENTS;

/// What the filters of a query's hits get at.
struct QueryContext : RTCRayQueryContext
{
    CutoutWork cutouts;
    uint32_t own_strand = kNoStrand;
    const SceneRays* scene_rays = nullptr;
    MetTriangle blocker;
};

/// The arguments of a query besides its rays, which are marked incoherent.
class Query
{
public:
    /// @param filter   called for each hit, which it can reject; nullptr accepts all
    explicit Query(RTCFilterFunctionN filter = nullptr)
    {
        rtcInitRayQueryContext(&m_context);
        rtcInitOccludedArguments(&m_arguments);
        m_arguments.context = &m_context;
        m_arguments.flags = RTC_RAY_QUERY_FLAG_INCOHERENT;
        if (filter)
            m_arguments.flags = RTCRayQueryFlags(m_arguments.flags | RTC_RAY_QUERY_FLAG_INVOKE_ARGUMENT_FILTER);
        m_arguments.filter = filter;
    }
    void occluded8(const int* valid, RTCScene scene, RTCRay8& rays) { rtcOccluded8(valid, scene, &rays, &m_arguments); }
    /// The nearest hits.
    void intersect8(const int* valid, RTCScene scene, RTCRayHit8& rays)
    {
        RTCIntersectArguments arguments;
        rtcInitIntersectArguments(&arguments);
        arguments.context = &m_context;
        arguments.flags = m_arguments.flags;
        arguments.filter = m_arguments.filter;
        rtcIntersect8(valid, scene, &rays, &arguments);
    }
    const CutoutWork& cutouts() const { return m_context.cutouts; }
    /// Rays pass this strand: see StrandScene.
    void pass_strand(uint32_t strand) { m_context.own_strand = strand; }
    /// What a filter has noted.
    const MetTriangle& blocker() const { return m_context.blocker; }
    /// For filters, of a scene with instances. Must stay until the query is done.
    void set_scene_rays(const SceneRays* rays) { m_context.scene_rays = rays; }

private:
    QueryContext m_context;
    RTCOccludedArguments m_arguments;
};

/// The nearest hits of rays that run side by side.
inline void intersect8(const int* valid, RTCScene scene, RTCRayHit8& rays)
{
    RTCIntersectArguments arguments;
    rtcInitIntersectArguments(&arguments);
    arguments.flags = RTC_RAY_QUERY_FLAG_COHERENT;
    rtcIntersect8(valid, scene, &rays, &arguments);
}
#else
constexpr RTCSceneFlags kFilteredByQuery = RTC_SCENE_FLAG_CONTEXT_FILTER_FUNCTION;

struct QueryContext : RTCIntersectContext
{
    CutoutWork cutouts;
    uint32_t own_strand = kNoStrand;
    const SceneRays* scene_rays = nullptr;
    MetTriangle blocker;
};

class Query
{
public:
    explicit Query(RTCFilterFunctionN filter = nullptr)
    {
        rtcInitIntersectContext(&m_context);
        m_context.flags = RTC_INTERSECT_CONTEXT_FLAG_INCOHERENT;
        m_context.filter = filter;
    }
    void occluded8(const int* valid, RTCScene scene, RTCRay8& rays) { rtcOccluded8(valid, scene, &m_context, &rays); }
    void intersect8(const int* valid, RTCScene scene, RTCRayHit8& rays)
    {
        rtcIntersect8(valid, scene, &m_context, &rays);
    }
    const CutoutWork& cutouts() const { return m_context.cutouts; }
    /// Rays pass this strand: see StrandScene.
    void pass_strand(uint32_t strand) { m_context.own_strand = strand; }
    /// What a filter has noted.
    const MetTriangle& blocker() const { return m_context.blocker; }
    /// For filters, of a scene with instances. Must stay until the query is done.
    void set_scene_rays(const SceneRays* rays) { m_context.scene_rays = rays; }

private:
    QueryContext m_context;
};

inline void intersect8(const int* valid, RTCScene scene, RTCRayHit8& rays)
{
    RTCIntersectContext context;
    rtcInitIntersectContext(&context);
    context.flags = RTC_INTERSECT_CONTEXT_FLAG_COHERENT;
    rtcIntersect8(valid, scene, &context, &rays);
}
#endif

/// A bit for each of the lanes that are valid, -1, rather than 0. `n` is 1, 4, 8 or 16.
inline unsigned valid_lanes(const int* valid, unsigned n)
{
    unsigned lanes = 0;
    unsigned i = 0;
#if defined(__SSE__)
    for (; i + 4 <= n; i += 4)
        lanes |= unsigned(_mm_movemask_ps(_mm_loadu_ps(reinterpret_cast<const float*>(valid + i)))) << i;
#endif
    for (; i < n; ++i)
        lanes |= unsigned(valid[i] != 0) << i;
    return lanes;
}
/// The number of its lowest bit; not of 0.
inline unsigned first_lane(unsigned lanes)
{
    return unsigned(__builtin_ctz(lanes));
}

/// Flushes denormals to zero during its lifetime, as Embree recommends, then restores the thread's own setting, so that
/// hosts never see a difference. No effect on CPUs other than x86.
class FlushDenormals
{
#if defined(__SSE__)
public:
    FlushDenormals()
        : m_saved(_mm_getcsr())
    {
        _mm_setcsr(m_saved | 0x8040); // flush to zero, denormals are zero
    }
    ~FlushDenormals()
    {
        _mm_setcsr(m_saved);
    }

private:
    unsigned m_saved;
#else
public:
    FlushDenormals() { } // not defaulted: avoids warnings of unused variables
#endif
};

} // namespace vmlight::embree
