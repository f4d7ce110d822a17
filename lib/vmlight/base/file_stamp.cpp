// SPDX-License-Identifier: Apache-2.0
#include <vmlight/base/file_stamp.h>

#include <OpenImageIO/strutil.h>

#include <algorithm>
#include <cerrno>

#include <sys/stat.h>

namespace vmlight {

using OIIO::Strutil::fmt::format;

bool stamp_file(std::string& stamp, const std::string& path, std::string& error)
{
    struct stat status;
    // A '?' may stand in a file's name, or begin what another plugin wants to be told.
    if (::stat(path.c_str(), &status) != 0 && ::stat(path.substr(0, path.find('?')).c_str(), &status) != 0) {
        error = format("\"{}\": {}", path, errno == ENOENT || errno == ENOTDIR ? "no such file" : "cannot be read");
        return false;
    }
    if (!S_ISREG(status.st_mode)) { // a pipe would hold the host up
        error = format("\"{}\": not a file", path);
        return false;
    }
    // The time of its last change of any kind, too: content may be put in place with size and time kept.
    stamp = format("{}|{}|{}.{}|{}.{}|{}\n", path, status.st_size, status.st_mtim.tv_sec, status.st_mtim.tv_nsec,
                   status.st_ctim.tv_sec, status.st_ctim.tv_nsec, status.st_ino);
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

bool are_unchanged(const std::vector<FileStamp>& files)
{
    std::string ignored;
    return std::all_of(files.begin(), files.end(),
                       [&](const FileStamp& file) { return check_stamp(file.stamp, file.path, ignored); });
}

} // namespace vmlight
