// SPDX-License-Identifier: Apache-2.0
/// Files as they were when something was made of them.
#pragma once

#include <string>
#include <vector>

namespace vmlight {

/// A file as it is now: two stamps differ if the file was changed or replaced. False, with the reason in `error`, if
/// there is no such file, or it is no plain one: a pipe would hold its reader up. A ?query after the name is passed
/// over.
bool stamp_file(std::string& stamp, const std::string& path, std::string& error);

/// False, with the reason in `error`, if the file is not as it was.
bool check_stamp(const std::string& stamp, const std::string& path, std::string& error);

struct FileStamp
{
    std::string path, stamp;
};

/// Whether each of the files is as it was.
bool are_unchanged(const std::vector<FileStamp>& files);

} // namespace vmlight
