// SPDX-License-Identifier: Apache-2.0
/// Work handed to threads one item at a time, on OIIO's thread pool.
#pragma once

#include <vmlight/base/progress.h>

#include <cstdint>
#include <functional>

namespace vmlight {

/// Call `work(item, worker)` once for each item in [0, items), with worker in [0, workers), where workers =
/// worker_count(nthreads). A worker does one item at a time, so that `worker` may index scratch memory; which worker
/// gets which item is not determined, so results must not depend on it. The calling thread works too, and never takes
/// up other tasks of the pool while it waits: `work` may be done under a lock that such a task would want.
///
/// @param nthreads 0 means OIIO's default ("threads" attribute); 1 runs on the calling thread
/// @param progress called between items, from one thread at a time, with a share that grows and ends at 1; false from
///                 it stops the hand-out of items, and it is not called again
/// @returns false if `progress` stopped the work. What `work` throws stops it too, and is thrown on to the caller.
bool parallel_items(int64_t items, int nthreads, const std::function<void(int64_t item, int worker)>& work,
                    const Progress& progress = {});

/// While it lives, loops of OpenImageIO that this thread starts run on this thread alone. OIIO's own wait for its pool
/// runs whatever task is queued; under a lock, that may be one which wants the lock. Items of parallel_items() have
/// one.
class InlineLoops
{
public:
    InlineLoops();
    ~InlineLoops();
    InlineLoops(const InlineLoops&) = delete;
    InlineLoops& operator=(const InlineLoops&) = delete;

private:
    bool m_registered;
};

/// How many workers parallel_items() uses for this `nthreads`.
int worker_count(int nthreads);

} // namespace vmlight
