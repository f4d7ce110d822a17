// SPDX-License-Identifier: Apache-2.0
/// The only place that includes Embree, and where versions 3 and 4 differ. Not installed.
#pragma once

#if __has_include(<embree4/rtcore.h>)
#include <embree4/rtcore.h>
#else
#include <embree3/rtcore.h>
#endif

#if defined(__SSE__)
#include <xmmintrin.h>
#endif

namespace vmlight::embree {

#if RTC_VERSION_MAJOR >= 4
/// Needed by a scene whose queries bring a filter.
constexpr RTCSceneFlags kFilteredByQuery = RTC_SCENE_FLAG_FILTER_FUNCTION_IN_ARGUMENTS;

/// What a query carries besides its rays; rays share nothing, so the traversal is told not to expect coherence.
class Query
{
public:
    /// @param filter   is asked about each meeting that would block a ray; nullptr lets all block
    explicit Query(RTCFilterFunctionN filter = nullptr)
    {
        rtcInitOccludedArguments(&m_arguments);
        m_arguments.flags = RTC_RAY_QUERY_FLAG_INCOHERENT;
        if (filter)
            m_arguments.flags = RTCRayQueryFlags(m_arguments.flags | RTC_RAY_QUERY_FLAG_INVOKE_ARGUMENT_FILTER);
        m_arguments.filter = filter;
    }
    void occluded8(const int* valid, RTCScene scene, RTCRay8& rays) { rtcOccluded8(valid, scene, &rays, &m_arguments); }

private:
    RTCOccludedArguments m_arguments;
};
#else
constexpr RTCSceneFlags kFilteredByQuery = RTC_SCENE_FLAG_CONTEXT_FILTER_FUNCTION;

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

private:
    RTCIntersectContext m_context;
};
#endif

/// Denormals count as zero while this lives, as Embree advises; the thread's own setting comes back with its end, so
/// that a host never sees the difference. Processors other than x86 stay as they are set.
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
    FlushDenormals() { } // not defaulted: an object of this class is no unused variable
#endif
};

} // namespace vmlight::embree
