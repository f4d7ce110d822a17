// SPDX-License-Identifier: Apache-2.0
#include <vmlight/base/file_watch.h>

#include <vmlight/base/format.h>

#ifdef __linux__

#include <cerrno>
#include <chrono>
#include <cstring>
#include <filesystem>
#include <set>
#include <system_error>

#include <poll.h>
#include <sys/inotify.h>
#include <sys/stat.h>
#include <unistd.h>

namespace vmlight {
namespace {

namespace fs = std::filesystem;

constexpr uint32_t kEvents = IN_CLOSE_WRITE | IN_MOVED_FROM | IN_MOVED_TO | IN_CREATE | IN_DELETE | IN_ATTRIB
    | IN_DELETE_SELF | IN_MOVE_SELF | IN_ONLYDIR;
constexpr int kQuietMilliseconds = 50, kLongestMilliseconds = 1000, kMostLinks = 40;

// The folders whose entries decide what `path` means.
void add_folders(std::set<std::string>& folders, const fs::path& path, int links)
{
    std::error_code error;
    fs::path place;
    for (const fs::path& part : path) {
        const fs::path folder = place;
        place /= part;
        if (!fs::is_symlink(place, error) || links == 0)
            continue;
        folders.insert(folder.string());
        add_folders(folders, folder / fs::read_symlink(place, error), links - 1);
    }
    fs::path folder = path.parent_path();
    while (folder.has_relative_path() && !fs::is_directory(folder, error))
        folder = folder.parent_path();
    folders.insert(folder.string());
}

// A file that was created is being written: it is closed later. A link, or a folder, is whole.
bool is_being_written(const std::string& path)
{
    struct stat status;
    return ::lstat(path.c_str(), &status) == 0 && S_ISREG(status.st_mode) && status.st_nlink == 1;
}

} // namespace

std::string FileWatch::fault()
{
    return "";
}

FileWatch::~FileWatch()
{
    if (m_descriptor >= 0)
        ::close(m_descriptor);
}

bool FileWatch::follow(const std::vector<std::string>& paths, std::string& error)
{
    if (m_descriptor < 0)
        m_descriptor = ::inotify_init1(IN_CLOEXEC | IN_NONBLOCK);
    if (m_descriptor < 0) {
        error = format("cannot watch files: {}", std::strerror(errno));
        return false;
    }
    std::set<std::string> folders;
    for (const std::string& path : paths) {
        std::error_code ignored;
        const bool has_query = !fs::exists(path, ignored) && path.find('?') != std::string::npos;
        add_folders(folders, fs::absolute(path.substr(0, has_query ? path.find('?') : path.size())), kMostLinks);
    }
    std::map<int, std::string> followed;
    for (const std::string& folder : folders) {
        const int watch = ::inotify_add_watch(m_descriptor, folder.c_str(), kEvents);
        if (watch < 0 && errno != ENOENT && errno != ENOTDIR) {
            error = errno == ENOSPC
                ? format("\"{}\": cannot be watched: the system allows no more watches (fs.inotify.max_user_watches)",
                         folder)
                : format("\"{}\": cannot be watched: {}", folder, std::strerror(errno));
            return false;
        }
        if (watch >= 0)
            followed[watch] = folder;
    }
    for (const auto& [watch, folder] : m_folders)
        if (followed.count(watch) == 0)
            ::inotify_rm_watch(m_descriptor, watch);
    m_folders = std::move(followed);
    return true;
}

// Whether one that matters came in time.
bool FileWatch::read_events(int milliseconds)
{
    pollfd ready { m_descriptor, POLLIN, 0 };
    if (::poll(&ready, 1, milliseconds) <= 0)
        return false;
    alignas(inotify_event) char bytes[16384];
    bool matters = false;
    for (ssize_t count; (count = ::read(m_descriptor, bytes, sizeof(bytes))) > 0;)
        for (ssize_t at = 0; at < count;) {
            const auto* event = reinterpret_cast<const inotify_event*>(bytes + at);
            const auto folder = m_folders.find(event->wd);
            const std::string name = event->len > 0 ? event->name : "";
            matters = matters || (event->mask & IN_CREATE) == 0 || folder == m_folders.end()
                || !is_being_written(folder->second + "/" + name);
            at += ssize_t(sizeof(inotify_event) + event->len);
        }
    return matters;
}

void FileWatch::wait()
{
    while (!read_events(-1)) { }
    const auto begin = std::chrono::steady_clock::now();
    while (std::chrono::steady_clock::now() - begin < std::chrono::milliseconds(kLongestMilliseconds)
           && read_events(kQuietMilliseconds)) { }
}

} // namespace vmlight

#else

namespace vmlight {

std::string FileWatch::fault()
{
    return "files can be watched on Linux only";
}

FileWatch::~FileWatch() = default;

bool FileWatch::follow(const std::vector<std::string>&, std::string& error)
{
    error = fault();
    return false;
}

bool FileWatch::read_events(int)
{
    return false;
}

void FileWatch::wait() { }

} // namespace vmlight

#endif
