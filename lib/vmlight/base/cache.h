// SPDX-License-Identifier: Apache-2.0
/// Things that are made once, however many threads ask for them.
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

/// Work that the first thread to ask does, while the others wait. Its failure is kept; what it throws is not.
/// The work never waits for OIIO's thread pool to run other tasks: one of them may want this very result.
class Once
{
public:
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

/// Values by key, each made once; beyond `limit` bytes those go first that were asked for longest ago. Who holds a
/// value keeps it. Values have bytes().
template <class Key, class Value> class OnceCache
{
public:
    using Pointer = std::shared_ptr<const Value>;

    explicit OnceCache(size_t limit)
        : m_limit(limit)
    {
    }

    /// The value of `key`, made by `make()` if it is not there. Threads that ask for it meanwhile wait.
    template <class Make> Pointer get(const Key& key, Make&& make)
    {
        std::unique_lock<std::mutex> lock(m_mutex);
        for (auto found = m_entries.find(key); found != m_entries.end(); found = m_entries.find(key)) {
            if (found->second.value) {
                m_recent.splice(m_recent.begin(), m_recent, found->second.place);
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

    /// Drop the values with keys in [first, last).
    void forget(const Key& first, const Key& last)
    {
        const std::lock_guard<std::mutex> lock(m_mutex);
        for (auto entry = m_entries.lower_bound(first); entry != m_entries.end() && entry->first < last;) {
            const auto next = std::next(entry);
            if (entry->second.value)
                drop(entry);
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
        Pointer value; // none while it is being made
        typename std::list<Key>::iterator place {};
    };

    void drop(typename std::map<Key, Entry>::iterator entry)
    {
        m_bytes -= entry->second.value->bytes();
        m_recent.erase(entry->second.place);
        m_entries.erase(entry);
    }
    // The newest stays, whatever its size: those who wait for it are about to take it.
    void trim()
    {
        while (m_bytes > m_limit && m_recent.size() > 1)
            drop(m_entries.find(m_recent.back()));
    }

    mutable std::mutex m_mutex;
    std::condition_variable m_made;
    std::map<Key, Entry> m_entries;
    std::list<Key> m_recent; // keys with a value, the last asked for first
    size_t m_bytes = 0, m_limit;
};

} // namespace vmlight
