// SPDX-License-Identifier: Apache-2.0
#include <vmlight/base/available_memory.h>

#include <vmlight/base/format.h>

#include <OpenImageIO/strutil.h>

#include <algorithm>
#include <fstream>
#include <iterator>
#include <limits>
#include <vector>

#if defined(__GLIBC__)
#include <malloc.h>
#endif
#include <sys/resource.h>
#include <unistd.h>

namespace vmlight {
namespace {

using OIIO::Strutil::memformat;
using OIIO::Strutil::splits;
using OIIO::Strutil::starts_with;

constexpr int64_t kUnknown = std::numeric_limits<int64_t>::max();

// "" if there is no such file. Files in /proc have no size in advance.
std::string read_text(const std::string& path)
{
    std::ifstream file(path);
    return std::string(std::istreambuf_iterator<char>(file), {});
}

// The number after `key` at the start of a line, or `fallback`, also for values such as "max" or 2^64 - 1.
int64_t number_after(const std::string& text, const std::string& key, int64_t fallback)
{
    for (const std::string& line : splits(text, "\n")) {
        if (!starts_with(line, key))
            continue;
        const std::string number = std::string(OIIO::Strutil::strip(line.substr(key.size())));
        const size_t digits = std::min(number.find_first_not_of("0123456789"), number.size());
        return digits > 0 && digits < 18 ? std::stoll(number.substr(0, digits)) : fallback;
    }
    return fallback;
}

int64_t free_swap(const std::string& root)
{
    return 1024 * number_after(read_text(root + "/proc/meminfo"), "SwapFree:", 0);
}

int64_t left_by_machine(const std::string& root, int64_t swap)
{
    const int64_t kilobytes = number_after(read_text(root + "/proc/meminfo"), "MemAvailable:", -1);
    return kilobytes < 0 ? kUnknown : 1024 * kilobytes + swap;
}

// File names, and keys in memory.stat, of one version of control groups.
struct GroupFiles
{
    const char *limit, *usage, *cache, *shared;
};
constexpr GroupFiles kFirst { "memory.limit_in_bytes", "memory.usage_in_bytes", "total_cache ", "total_shmem " };
constexpr GroupFiles kSecond { "memory.max", "memory.current", "file ", "shmem " };

// What is left in a group and its parents, each with at most `swap` bytes of swap. `folder` is the mount point of the
// hierarchy, `group` the path in it.
int64_t left_by_groups(const std::string& folder, std::string group, const GroupFiles& files, int64_t swap)
{
    int64_t left = kUnknown;
    for (;;) {
        const std::string at = folder + group + "/", stat = read_text(at + "memory.stat");
        const int64_t limit = number_after(read_text(at + files.limit), "", kUnknown);
        const int64_t used = number_after(read_text(at + files.usage), "", 0);
        // tmpfs pages count as page cache but cannot be reclaimed.
        const int64_t cache = number_after(stat, files.cache, 0) - number_after(stat, files.shared, 0);
        const int64_t own_swap = number_after(read_text(at + "memory.swap.max"), "", swap);
        if (limit != kUnknown)
            left = std::min(left, std::max<int64_t>(0, limit - used + cache) + std::min(swap, own_swap));
        if (group.empty() || group == "/")
            return left;
        group.erase(group.rfind('/'));
    }
}

int64_t left_by_groups(const std::string& root, int64_t swap)
{
    int64_t left = kUnknown;
    const std::string groups = root + "/sys/fs/cgroup";
    for (const std::string& line : splits(read_text(root + "/proc/self/cgroup"), "\n")) {
        const std::vector<std::string> parts = splits(line, ":", 3); // number:controllers:path
        if (parts.size() < 3 || !starts_with(parts[2], "/"))
            continue;
        const std::vector<std::string> controllers = splits(parts[1], ",");
        if (parts[1].empty())
            left = std::min(left, left_by_groups(groups, parts[2], kSecond, swap));
        else if (std::find(controllers.begin(), controllers.end(), "memory") != controllers.end())
            left = std::min(left, left_by_groups(groups + "/memory", parts[2], kFirst, swap));
    }
    return left;
}

int64_t left_by_limit(int resource, int64_t used)
{
    rlimit limit;
    if (::getrlimit(resource, &limit) != 0 || limit.rlim_cur == RLIM_INFINITY)
        return kUnknown;
    return std::max<int64_t>(0, int64_t(std::min<rlim_t>(limit.rlim_cur, kUnknown)) - used);
}

int64_t left_by_limits(const std::string& root)
{
    const std::string status = read_text(root + "/proc/self/status");
    return std::min(left_by_limit(RLIMIT_AS, 1024 * number_after(status, "VmSize:", 0)),
                    left_by_limit(RLIMIT_DATA, 1024 * number_after(status, "VmData:", 0)));
}

} // namespace

int64_t available_memory(const std::string& root)
{
    const int64_t swap = free_swap(root);
    return std::min({ left_by_machine(root, swap), left_by_groups(root, swap), left_by_limits(root) });
}

void release_freed_memory()
{
#if defined(__GLIBC__)
    ::malloc_trim(0);
#endif
}

std::string memory_shortage(const OIIO::ImageSpec& spec, double more)
{
    const double bytes
        = double(spec.width) * spec.height * std::max(1, spec.depth) * spec.nchannels * sizeof(float) + more;
    const int64_t available = available_memory();
    if (bytes <= double(available))
        return "";
    return format("{}x{} pixels of {} channels need {} of memory, {} available", spec.width, spec.height,
                  spec.nchannels, memformat(int64_t(std::min(bytes, 1e18))), memformat(available));
}

} // namespace vmlight
