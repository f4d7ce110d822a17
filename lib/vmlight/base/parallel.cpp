// SPDX-License-Identifier: Apache-2.0
#include <vmlight/base/parallel.h>

#include <vmlight/base/tsan_handoff.h>

#include <OpenImageIO/imageio.h>
#include <OpenImageIO/thread.h>

#include <algorithm>
#include <atomic>
#include <condition_variable>
#include <exception>
#include <memory>
#include <mutex>
#include <thread>
#include <vector>

#include <pthread.h>

namespace vmlight {
namespace {

// Counts active workers. OIIO's own wait runs any queued task, which deadlocks if that task needs what the waiting
// thread is about to make. Here the caller works until no items are left, turns away the workers that have not started,
// and waits for those that are busy with the last items.
class WorkerGate
{
public:
    bool enter()
    {
        const std::lock_guard<std::mutex> lock(m_mutex);
        m_inside += !m_closed;
        return !m_closed;
    }
    void leave()
    {
        const std::lock_guard<std::mutex> lock(m_mutex);
        if (--m_inside == 0)
            m_empty.notify_all();
    }
    void close()
    {
        std::unique_lock<std::mutex> lock(m_mutex);
        m_closed = true;
        m_empty.wait(lock, [this] { return m_inside == 0; });
    }

private:
    std::mutex m_mutex;
    std::condition_variable m_empty;
    int m_inside = 0;
    bool m_closed = false;
};

} // namespace

// OIIO runs loops inline on threads that are registered as workers of its pool.
InlineLoops::InlineLoops()
    : m_registered(!OIIO::default_thread_pool()->is_worker(std::this_thread::get_id()))
{
    if (m_registered)
        OIIO::default_thread_pool()->register_worker(std::this_thread::get_id());
}

InlineLoops::~InlineLoops()
{
    if (m_registered)
        OIIO::default_thread_pool()->deregister_worker(std::this_thread::get_id());
}

int worker_count(int nthreads)
{
    return nthreads > 0 ? nthreads : std::max(1, OIIO::get_int_attribute("threads"));
}

bool can_start_threads(int count)
{
    constexpr size_t kStack = size_t(64) << 10; // enough to wait
    pthread_attr_t attributes;
    pthread_attr_init(&attributes);
    pthread_attr_setstacksize(&attributes, kStack);
    std::mutex all_started;
    std::vector<pthread_t> threads;
    bool good = true;
    {
        const std::lock_guard<std::mutex> lock(all_started);
        const auto wait = [](void* mutex) -> void* {
            const std::lock_guard<std::mutex> lock(*static_cast<std::mutex*>(mutex));
            return nullptr;
        };
        while (good && int(threads.size()) < count) {
            pthread_t thread;
            good = pthread_create(&thread, &attributes, wait, &all_started) == 0;
            if (good)
                threads.push_back(thread);
        }
    }
    for (const pthread_t thread : threads)
        pthread_join(thread, nullptr);
    pthread_attr_destroy(&attributes);
    return good;
}

bool parallel_items(int64_t items, int nthreads, const std::function<void(int64_t, int)>& work,
                    const Progress& progress)
{
    std::atomic<int64_t> next { 0 }, finished { 0 };
    std::atomic<bool> stopped { false };
    std::mutex reporting;
    double reported = 0;
    std::exception_ptr failure; // OIIO's pool would drop it

    // Called under the lock, so that the reported fraction never decreases.
    const auto report = [&] {
        const double done = double(finished) / double(items);
        if (!stopped && done > reported && !progress(reported = done))
            stopped = true;
    };
    const auto run = [&](int worker) {
        const InlineLoops inline_loops; // an item may hold a lock that another item wants
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
            // If another worker is reporting, carry on: progress must never delay the work.
            const std::unique_lock<std::mutex> lock(reporting, std::try_to_lock);
            if (lock)
                report();
        }
    };

    // OIIO's parallel_for splits the range into as many chunks as threads, which leaves threads idle when chunks differ
    // in cost. Here each worker takes the next item when it is free.
    const int workers = int(std::min<int64_t>(worker_count(nthreads), std::max<int64_t>(1, items)));
    const auto gate = std::make_shared<WorkerGate>();
    for (int worker = 1; worker < workers; ++worker) {
        const TsanRelease release;
        OIIO::default_thread_pool()->push([gate, worker, &run](int) {
            tsan_acquire();
            if (gate->enter()) {
                run(worker);
                gate->leave();
            }
        });
    }
    run(0);
    gate->close();
    if (failure)
        std::rethrow_exception(failure);
    if (progress && items > 0)
        report(); // the last item may have finished while another worker was reporting
    return !stopped;
}

} // namespace vmlight
