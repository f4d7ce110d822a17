// SPDX-License-Identifier: Apache-2.0
#include <vmlight/pixel_source.h>

#include <vmlight/stage_counts.h>
#include <vmlight/stored_image.h>

#include <OpenImageIO/filesystem.h>
#include <OpenImageIO/strutil.h>

#include <algorithm>
#include <cerrno>
#include <filesystem>
#include <iterator>
#include <list>
#include <mutex>

#include <sys/stat.h>

namespace vmlight {
namespace {

using OIIO::Strutil::fmt::format;

// Chains are short; one this long is a script that writes recipes gone wrong.
constexpr size_t kLongestChain = 32;

// Those used last stand first. What is dropped ends after the lock does: it may be large.
class Sources
{
public:
    PixelSourcePointer find(const std::string& key)
    {
        List dropped;
        const std::lock_guard<std::mutex> lock(m_mutex);
        const auto found = place(key);
        if (found == m_sources.end())
            return nullptr;
        if ((*found)->failed()) {
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
    size_t m_bytes = size_t(1) << 30, m_count = 64;
};

// Never taken down: threads of the host may still read while the process ends.
Sources& sources()
{
    static auto& all = *new Sources;
    return all;
}

// One name for one file, by whatever way to its folder. The name is as it was given, a link or not: it may say a UDIM
// tile. A ring through links comes back to a name all the same.
std::string identity(const std::string& name)
{
    const std::filesystem::path path = without_query(name);
    std::error_code none;
    const std::filesystem::path folder
        = std::filesystem::weakly_canonical(std::filesystem::absolute(path, none).parent_path(), none);
    return (none ? path : folder / path.filename()).string() + name.substr(path.string().size());
}

bool link_chain(RecipeChain& chain, const std::string& name, std::string& error)
{
    const std::string id = identity(name);
    const auto first = std::find(chain.begin(), chain.end(), id);
    const bool is_loop = first != chain.end();
    if (!is_loop && chain.size() < kLongestChain) {
        chain.push_back(id);
        return true;
    }
    error
        = is_loop ? format("\"{}\" reads itself", id) : format("more than {} recipes read one another", kLongestChain);
    for (auto link = is_loop ? first : chain.begin(); link != chain.end(); ++link)
        error += format("{} \"{}\"", link == (is_loop ? first : chain.begin()) ? ":" : " ->", *link);
    error += format(" -> \"{}\"", id);
    return false;
}

template <class Recipe>
PixelSourcePointer open_recipe(const std::string& name, std::string& error, const RecipeChain& chain)
{
    Recipe recipe;
    RecipeChain longer = chain;
    if (!link_chain(longer, name, error) || !read_recipe(recipe, name, error))
        return nullptr;
    PixelSourcePointer source = open_source(recipe, error, longer);
    // An error of the chain is long enough, and names all that are part of it.
    if (!source && error.find(" -> ") == std::string::npos)
        error = format("\"{}\": {}", without_query(name), error);
    return source;
}

} // namespace

StageCounts& stage_counts()
{
    static StageCounts counts;
    return counts;
}

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

bool stamp_file(std::string& stamp, const std::string& path, std::string& error)
{
    struct stat status;
    // A '?' may stand in a file's name, or begin what another plugin wants to be told.
    if (::stat(path.c_str(), &status) != 0 && ::stat(without_query(path).c_str(), &status) != 0) {
        error = format("\"{}\": {}", path, errno == ENOENT || errno == ENOTDIR ? "no such file" : "cannot be read");
        return false;
    }
    if (S_ISDIR(status.st_mode)) {
        error = format("\"{}\": not a file", path);
        return false;
    }
    stamp = format("{}|{}|{}.{}|{}\n", path, status.st_size, status.st_mtim.tv_sec, status.st_mtim.tv_nsec,
                   status.st_ino);
    return true;
}

bool check_stamp(const std::string& stamp, const std::string& path, std::string& error)
{
    std::string now;
    if (!stamp_file(now, path, error))
        return false;
    if (now != stamp)
        error = format("\"{}\": changed since it was opened", path);
    return now == stamp;
}

PixelSourcePointer open_source(const std::string& name, std::string& error, const RecipeChain& chain)
{
    const std::string extension = OIIO::Strutil::lower(OIIO::Filesystem::extension(without_query(name), false));
    if (extension == VismapRecipe::kStage)
        return open_recipe<VismapRecipe>(name, error, chain);
    if (extension == CfemRecipe::kStage)
        return open_recipe<CfemRecipe>(name, error, chain);
    if (extension == LightmapRecipe::kStage)
        return open_recipe<LightmapRecipe>(name, error, chain);
    return open_stored_image(name, error);
}

} // namespace vmlight
