// SPDX-License-Identifier: Apache-2.0
/// For the thread sanitizer: OIIO's pool, which is not built with it, hands work to other threads unseen. So that is
/// done under a lock, which whoever takes the work takes first. In other builds nothing is done.
#pragma once

#include <vmlight/base/sanitizers.h>

#include <mutex>

namespace vmlight {

inline std::mutex& hand() // one for all: nothing of a task may be looked at before it is taken
{
    static std::mutex hand;
    return hand;
}

/// While this lives, work is handed over.
class HandingOver
{
#if defined(__SANITIZE_THREAD__)
public:
    HandingOver()
        : m_lock(hand())
    {
    }

private:
    std::lock_guard<std::mutex> m_lock;
#else
public:
    HandingOver() { } // not defaulted: an object of this class is no unused variable
#endif
};

/// To be called before anything of the work is looked at.
inline void take_over()
{
    const HandingOver after_all;
}

} // namespace vmlight
