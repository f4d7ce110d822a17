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
/// What a query carries besides its rays; rays share nothing, so the traversal is told not to expect coherence.
class Query
{
public:
    Query()
    {
        rtcInitOccludedArguments(&m_arguments);
        m_arguments.flags = RTC_RAY_QUERY_FLAG_INCOHERENT;
    }
    void occluded8(const int* valid, RTCScene scene, RTCRay8& rays) { rtcOccluded8(valid, scene, &rays, &m_arguments); }

private:
    RTCOccludedArguments m_arguments;
};
#else
class Query
{
public:
    Query()
    {
        rtcInitIntersectContext(&m_context);
        m_context.flags = RTC_INTERSECT_CONTEXT_FLAG_INCOHERENT;
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
