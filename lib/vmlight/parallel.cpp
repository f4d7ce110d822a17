// SPDX-License-Identifier: Apache-2.0
#include <vmlight/parallel.h>

#include <OpenImageIO/imageio.h>
#include <OpenImageIO/parallel.h>

#include <algorithm>
#include <atomic>
#include <exception>
#include <mutex>

namespace vmlight {

int worker_count(int nthreads)
{
    return nthreads > 0 ? nthreads : std::max(1, OIIO::get_int_attribute("threads"));
}

bool parallel_items(int64_t items, int nthreads, const std::function<void(int64_t, int)>& work,
                    const Progress& progress)
{
    std::atomic<int64_t> next { 0 }, finished { 0 };
    std::atomic<bool> stopped { false };
    std::mutex reporting;
    double reported = 0;
    std::exception_ptr failure; // OIIO's pool would swallow it

    // Under the lock, so that what is reported only ever grows.
    const auto report = [&] {
        const double done = double(finished) / double(items);
        if (!stopped && done > reported && !progress(reported = done))
            stopped = true;
    };
    const auto run = [&](int worker) {
        for (int64_t item; !stopped && (item = next++) < items;) {
            try {
                work(item, worker);
            } catch (...) {
                const std::lock_guard<std::mutex> lock(reporting);
                if (!failure)
                    failure = std::current_exception();
                stopped = true;
                return;
            }
            ++finished;
            if (!progress)
                continue;
            // A worker that finds another one reporting goes on: progress must never hold up the work.
            const std::unique_lock<std::mutex> lock(reporting, std::try_to_lock);
            if (lock)
                report();
        }
    };

    // OIIO's own division of labour cuts the range into as many pieces as threads, which leaves a thread idle when
    // pieces differ in cost; here each worker takes the next item when it is free.
    const int workers = int(std::min<int64_t>(worker_count(nthreads), std::max<int64_t>(1, items)));
    if (workers == 1)
        run(0);
    else
        OIIO::parallel_for_chunked(0, workers, 1, [&](int64_t begin, int64_t end) {
            for (int64_t worker = begin; worker < end; ++worker)
                run(int(worker));
        });
    if (failure)
        std::rethrow_exception(failure);
    if (progress && items > 0)
        report(); // the last item's, if another worker was reporting when it ended
    return !stopped;
}

} // namespace vmlight
