// SPDX-License-Identifier: Apache-2.0
#include "start.h"

#include <vmlight/base/format.h>

#include <cerrno>
#include <cstring>
#include <filesystem>
#include <system_error>

#include <unistd.h>

namespace vmlight::front {

std::string own_folder()
{
    std::error_code ignored;
    return std::filesystem::read_symlink("/proc/self/exe", ignored).parent_path().string();
}

std::string start(const std::string& path, const char** argv)
{
    ::execv(path.c_str(), const_cast<char* const*>(argv));
    return format("\"{}\": {}", path, std::strerror(errno));
}

std::string start_from_path(const std::string& name, const char** argv)
{
    ::execvp(name.c_str(), const_cast<char* const*>(argv));
    return format("\"{}\": {}", name, std::strerror(errno));
}

} // namespace vmlight::front
