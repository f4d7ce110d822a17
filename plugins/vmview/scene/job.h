// SPDX-License-Identifier: Apache-2.0
/// Work on a thread of its own, whose results the thread that draws takes when it is ready.
#pragma once

#include <vmlight/base/progress.h>

#include <atomic>
#include <functional>
#include <mutex>
#include <optional>
#include <string>
#include <thread>
#include <utility>

namespace vmlight::view {

/// What a job has to say: a result, or why there is none.
template <class T> struct JobResult
{
    T value {};
    std::string error; ///< not "": there is no value
    bool is_last = false;
};

template <class T> class Job
{
public:
    /// Hands over a result; a later one replaces one that was not taken.
    using Post = std::function<void(JobResult<T>)>;
    /// Does the work, and stops soon after `go_on` returns false.
    using Work = std::function<void(const Post& post, const Progress& go_on)>;

    /// @param wake     called from the job's thread after each result
    explicit Job(std::function<void()> wake = {})
        : m_wake(std::move(wake))
    {
    }
    ~Job() { stop(); }
    Job(const Job&) = delete;
    Job& operator=(const Job&) = delete;

    /// Start `work`, after stopping what runs; results of that which were not taken are dropped.
    void start(Work work)
    {
        stop();
        m_stopped = false;
        m_running = true;
        m_done = 0;
        m_thread = std::thread([this, work = std::move(work)] { run(work); });
    }

    /// Stop the work, wait for its thread, and drop its result.
    void stop()
    {
        m_stopped = true;
        if (m_thread.joinable())
            m_thread.join();
        m_result.reset();
        m_running = false;
    }

    /// Whether it runs, or its last result was not taken.
    bool is_busy() const
    {
        const std::lock_guard<std::mutex> lock(m_mutex);
        return m_running || m_result;
    }
    /// The share of the present step that is done.
    double done() const { return m_done; }

    /// The newest result, once; nothing if there is none.
    std::optional<JobResult<T>> take()
    {
        const std::lock_guard<std::mutex> lock(m_mutex);
        std::optional<JobResult<T>> taken;
        taken.swap(m_result);
        return taken;
    }

private:
    void run(const Work& work)
    {
        const auto post = [this](JobResult<T> result) {
            {
                const std::lock_guard<std::mutex> lock(m_mutex);
                if (m_stopped)
                    return;
                m_result = std::move(result);
            }
            if (m_wake)
                m_wake();
        };
        const auto go_on = [this](double done) {
            m_done = done;
            return !m_stopped;
        };
        try {
            work(post, go_on);
        } catch (const std::exception& exception) {
            JobResult<T> failed;
            failed.error = exception.what();
            failed.is_last = true;
            post(std::move(failed));
        }
        m_running = false;
        if (m_wake && !m_stopped)
            m_wake();
    }

    const std::function<void()> m_wake;
    std::thread m_thread;
    std::atomic<bool> m_stopped { false }, m_running { false };
    std::atomic<double> m_done { 0 };
    mutable std::mutex m_mutex;
    std::optional<JobResult<T>> m_result;
};

} // namespace vmlight::view
