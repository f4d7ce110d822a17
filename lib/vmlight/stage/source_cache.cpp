// SPDX-License-Identifier: Apache-2.0
#include <vmlight/stage/source_cache.h>

#include <algorithm>
#include <iterator>
#include <list>
#include <map>
#include <memory>
#include <mutex>
#include <utility>

namespace vmlight {
namespace {

// Most recently used first. Dropped sources are destroyed after the lock is released: they may be large.
class Sources
{
public:
    PixelSourcePointer find(const std::string& key)
    {
        List dropped;
        const std::lock_guard<std::mutex> lock(m_mutex);
        auto found = place(key);
        if (found == m_sources.end()) {
            const auto open = m_open.find(key);
            PixelSourcePointer source = open == m_open.end() ? nullptr : open->second.lock();
            if (!source)
                return nullptr;
            found = m_sources.insert(m_sources.begin(), std::move(source));
        }
        if ((*found)->failed()) {
            m_open.erase(key);
            dropped.splice(dropped.end(), m_sources, found);
            return nullptr;
        }
        m_sources.splice(m_sources.begin(), m_sources, found);
        trim(dropped);
        return m_sources.front();
    }
    PixelSourcePointer keep(PixelSourcePointer source)
    {
        List dropped;
        const std::lock_guard<std::mutex> lock(m_mutex);
        const auto found = place(source->key());
        if (found != m_sources.end() && !(*found)->failed())
            return *found;
        m_sources.push_front(source);
        for (auto open = m_open.begin(); open != m_open.end();)
            open = open->second.expired() ? m_open.erase(open) : std::next(open);
        m_open[source->key()] = source;
        trim(dropped);
        return source;
    }
    void set_limits(size_t bytes, size_t sources)
    {
        List dropped;
        const std::lock_guard<std::mutex> lock(m_mutex);
        m_bytes = bytes;
        m_count = std::max<size_t>(1, sources);
        trim(dropped);
    }

private:
    using List = std::list<PixelSourcePointer>;
    List::iterator place(const std::string& key)
    {
        return std::find_if(m_sources.begin(), m_sources.end(), [&](const auto& s) { return s->key() == key; });
    }
    void trim(List& dropped)
    {
        size_t bytes = 0;
        for (const auto& source : m_sources)
            bytes += source->bytes();
        while (m_sources.size() > 1 && (m_sources.size() > m_count || bytes > m_bytes)) {
            bytes -= std::min(bytes, m_sources.back()->bytes());
            dropped.splice(dropped.end(), m_sources, std::prev(m_sources.end()));
        }
    }
    std::mutex m_mutex;
    List m_sources;
    // Finds sources that someone still has open after the list dropped them.
    std::map<std::string, std::weak_ptr<PixelSource>> m_open;
    size_t m_bytes = size_t(1) << 30, m_count = 64;
};

// Never destroyed: host threads may still read while the process exits.
Sources& sources()
{
    static auto& all = *new Sources;
    return all;
}

} // namespace

PixelSourcePointer find_source(const std::string& key)
{
    return sources().find(key);
}

PixelSourcePointer keep_source(PixelSourcePointer source)
{
    return sources().keep(std::move(source));
}

void set_source_limits(size_t bytes, size_t count)
{
    sources().set_limits(bytes, count);
}

} // namespace vmlight
