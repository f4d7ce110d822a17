// SPDX-License-Identifier: Apache-2.0
/// Detects files that changed since they were read.
#pragma once

#include <string>
#include <vector>

namespace vmlight {

/// Set `stamp` to the file's current size, times and inode: two stamps differ if the file was changed or replaced.
/// Returns false, with the reason in `error`, if there is no such file or it is not a regular file (a pipe would block
/// its reader). A ?query after the name is ignored.
bool stamp_file(std::string& stamp, const std::string& path, std::string& error);

/// Returns false, with the reason in `error`, if the file changed since it was stamped.
bool check_stamp(const std::string& stamp, const std::string& path, std::string& error);

/// Note the file `path`, which is read without a stamp, in the StampLog.
void log_file(const std::string& path);

struct FileStamp
{
    std::string path, stamp;
};

/// Add a file that is about to be read. One without a stamp is left out: reading it fails.
void note_file(std::vector<FileStamp>& files, const std::string& path);

/// Whether none of the files changed.
bool are_unchanged(const std::vector<FileStamp>& files);

/// Notes each file that is stamped while it exists, by any thread: all that an image is made of. One at a time.
class StampLog
{
public:
    StampLog();
    ~StampLog();
    StampLog(const StampLog&) = delete;
    StampLog& operator=(const StampLog&) = delete;

    static void clear();
    /// Sorted by path; each with its first stamp since the log was cleared, "" if it could not be read.
    static std::vector<FileStamp> files();
};

} // namespace vmlight
