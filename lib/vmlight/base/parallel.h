// SPDX-License-Identifier: Apache-2.0
/// Dynamic scheduling of work items on OIIO's thread pool.
#pragma once

#include <vmlight/base/progress.h>

#include <cstdint>
#include <functional>

namespace vmlight {

/// Call `work(item, worker)` once for each item in [0, items), with worker in [0, worker_count(nthreads)). A worker
/// processes one item at a time, so `worker` may index scratch memory. Which worker gets which item is not
/// deterministic: results must not depend on it. The calling thread is worker 0. It never runs other tasks of the pool
/// while it waits, so the caller may hold a lock that such a task needs.
///
/// @param nthreads 0 means OIIO's default ("threads" attribute); 1 runs on the calling thread
/// @param progress called between items, from one thread at a time, with a fraction that increases to 1. If it returns
///                 false, no further items start and it is not called again
/// @returns false if `progress` stopped the work. The first exception from `work` stops it too and is rethrown.
bool parallel_items(int64_t items, int nthreads, const std::function<void(int64_t item, int worker)>& work,
                    const Progress& progress = {});

/// While one of these exists, OpenImageIO's parallel loops run on the calling thread alone. When OIIO waits for its
/// pool it runs any queued task, which may need a lock that the caller holds. parallel_items() makes one for each
/// worker.
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

/// Whether `count` more threads can run at once now. Libraries do not stand it if one of theirs does not start: OpenEXR
/// waits for it for ever. To be asked before they are used.
bool can_start_threads(int count);

/// Number of workers that parallel_items() uses for this `nthreads`.
int worker_count(int nthreads);

} // namespace vmlight
