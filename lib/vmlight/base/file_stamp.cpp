// SPDX-License-Identifier: Apache-2.0
#include <vmlight/base/file_stamp.h>

#include <vmlight/base/format.h>

#include <algorithm>
#include <atomic>
#include <cerrno>
#include <map>
#include <mutex>

#include <sys/stat.h>

namespace vmlight {
namespace {

std::atomic<bool> s_logs { false };
std::mutex s_log_mutex;

std::map<std::string, std::string>& logged_files()
{
    static auto& files = *new std::map<std::string, std::string>;
    return files;
}

bool stamp_now(std::string& stamp, const std::string& path, std::string& error)
{
    struct stat status;
    // A '?' may be part of a file's name, or start another plugin's query.
    if (::stat(path.c_str(), &status) != 0 && ::stat(path.substr(0, path.find('?')).c_str(), &status) != 0) {
        error = format("\"{}\": {}", path, errno == ENOENT || errno == ENOTDIR ? "no such file" : "cannot be read");
        return false;
    }
    if (!S_ISREG(status.st_mode)) { // a pipe would block the host
        error = format("\"{}\": not a file", path);
        return false;
    }
    // The change time too: tools can replace content and keep its size and modification time.
    stamp = format("{}|{}|{}.{}|{}.{}|{}\n", path, status.st_size, status.st_mtim.tv_sec, status.st_mtim.tv_nsec,
                   status.st_ctim.tv_sec, status.st_ctim.tv_nsec, status.st_ino);
    return true;
}

} // namespace

bool stamp_file(std::string& stamp, const std::string& path, std::string& error)
{
    const bool is_stamped = stamp_now(stamp, path, error);
    if (s_logs) {
        const std::lock_guard<std::mutex> lock(s_log_mutex);
        logged_files().emplace(path, is_stamped ? stamp : "");
    }
    return is_stamped;
}

void log_file(const std::string& path)
{
    std::string ignored;
    if (s_logs)
        stamp_file(ignored, path, ignored);
}

StampLog::StampLog()
{
    clear();
    s_logs = true;
}

StampLog::~StampLog()
{
    s_logs = false;
}

void StampLog::clear()
{
    const std::lock_guard<std::mutex> lock(s_log_mutex);
    logged_files().clear();
}

std::vector<FileStamp> StampLog::files()
{
    const std::lock_guard<std::mutex> lock(s_log_mutex);
    std::vector<FileStamp> found;
    for (const auto& [path, stamp] : logged_files())
        found.push_back({ path, stamp });
    return found;
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

void note_file(std::vector<FileStamp>& files, const std::string& path)
{
    FileStamp file { path, "" };
    std::string ignored;
    if (stamp_file(file.stamp, path, ignored))
        files.push_back(std::move(file));
}

bool are_unchanged(const std::vector<FileStamp>& files)
{
    std::string ignored;
    return std::all_of(files.begin(), files.end(),
                       [&](const FileStamp& file) { return check_stamp(file.stamp, file.path, ignored); });
}

} // namespace vmlight
