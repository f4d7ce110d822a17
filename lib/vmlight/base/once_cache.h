// SPDX-License-Identifier: Apache-2.0
/// Results that are computed once and shared by all threads that ask for them.
#pragma once

#include <vmlight/base/parallel.h>

#include <atomic>
#include <condition_variable>
#include <cstddef>
#include <list>
#include <map>
#include <memory>
#include <mutex>
#include <string>
#include <utility>

namespace vmlight {

/// Runs a function once: on the first thread that asks, while the others wait. A failure is remembered, an exception
/// is not: the next caller tries again. The function never waits for OIIO's thread pool to run other tasks, since one
/// of them may need this very result.
class RunOnce
{
public:
    /// Returns the result of `work(error)`, called now or earlier; on failure `error` is its reason.
    template <class Work> bool run(Work&& work, std::string& error)
    {
        if (m_state == State::good)
            return true;
        const std::lock_guard<std::mutex> lock(m_mutex);
        const InlineLoops inline_loops;
        if (m_state == State::open)
            m_state = work(m_error) ? State::good : State::bad;
        error = m_error;
        return m_state == State::good;
    }
    bool failed() const { return m_state == State::bad; }
    bool succeeded() const { return m_state == State::good; }

private:
    enum class State
    {
        open,
        good,
        bad
    };
    std::atomic<State> m_state { State::open };
    std::mutex m_mutex;
    std::string m_error;
};

/// A least-recently-used cache, bounded in bytes, that makes each value once. Values are shared: evicting one does not
/// invalidate the pointers that callers hold. `Value` must have bytes().
template <class Key, class Value> class OnceCache
{
public:
    using Pointer = std::shared_ptr<const Value>;

    explicit OnceCache(size_t limit)
        : m_limit(limit)
    {
    }

    /// The value of `key`, made by `make()` on a miss. Threads that ask for it meanwhile wait. If `make()` throws, so
    /// does get(), and the next call tries again.
    template <class Make> Pointer get(const Key& key, Make&& make)
    {
        std::unique_lock<std::mutex> lock(m_mutex);
        for (auto found = m_entries.find(key); found != m_entries.end(); found = m_entries.find(key)) {
            if (found->second.value) {
                m_recent.splice(m_recent.begin(), m_recent, found->second.position);
                return found->second.value;
            }
            m_made.wait(lock);
        }
        m_entries.emplace(key, Entry {});
        lock.unlock();
        Pointer value;
        try {
            const InlineLoops inline_loops;
            value = make();
        } catch (...) {
            lock.lock();
            m_entries.erase(key);
            m_made.notify_all();
            throw;
        }
        lock.lock();
        m_recent.push_front(key);
        m_entries[key] = { value, m_recent.begin() };
        m_bytes += value->bytes();
        trim();
        m_made.notify_all();
        return value;
    }

    void set_limit(size_t bytes)
    {
        const std::lock_guard<std::mutex> lock(m_mutex);
        m_limit = bytes;
        trim();
    }

    /// Evict the values with keys in [first, last).
    void erase(const Key& first, const Key& last)
    {
        const std::lock_guard<std::mutex> lock(m_mutex);
        for (auto entry = m_entries.lower_bound(first); entry != m_entries.end() && entry->first < last;) {
            const auto next = std::next(entry);
            if (entry->second.value)
                evict(entry);
            entry = next;
        }
    }

    size_t bytes() const
    {
        const std::lock_guard<std::mutex> lock(m_mutex);
        return m_bytes;
    }

private:
    struct Entry
    {
        Pointer value; // nullptr while it is being made
        typename std::list<Key>::iterator position {};
    };

    void evict(typename std::map<Key, Entry>::iterator entry)
    {
        m_bytes -= entry->second.value->bytes();
        m_recent.erase(entry->second.position);
        m_entries.erase(entry);
    }
    // The newest entry stays, whatever its size: threads that wait for it are about to use it.
    void trim()
    {
        while (m_bytes > m_limit && m_recent.size() > 1)
            evict(m_entries.find(m_recent.back()));
    }

    mutable std::mutex m_mutex;
    std::condition_variable m_made;
    std::map<Key, Entry> m_entries;
    std::list<Key> m_recent; // keys with a value, most recently used first
    size_t m_bytes = 0, m_limit;
};

} // namespace vmlight
