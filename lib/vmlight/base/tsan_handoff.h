// SPDX-License-Identifier: Apache-2.0
/// Annotations for ThreadSanitizer: it does not see how OIIO's thread pool, which is not instrumented, passes tasks to
/// other threads. Here the task is pushed under a lock, which the worker takes first. Does nothing in other builds.
#pragma once

#include <vmlight/base/sanitizers.h>

#include <mutex>

namespace vmlight {

inline std::mutex& tsan_handoff_mutex()
{
    static std::mutex mutex;
    return mutex;
}

/// Construct before a task is pushed, destroy after.
class TsanRelease
{
#if defined(__SANITIZE_THREAD__)
public:
    TsanRelease()
        : m_lock(tsan_handoff_mutex())
    {
    }

private:
    std::lock_guard<std::mutex> m_lock;
#else
public:
    TsanRelease() { } // not defaulted: avoids warnings about unused variables
#endif
};

/// Call in the task before it reads anything of the thread that pushed it.
inline void tsan_acquire()
{
    const TsanRelease synchronize;
}

} // namespace vmlight
