// SPDX-License-Identifier: Apache-2.0
#include <vmlight/mesh/import/side_files.h>

#include <OpenImageIO/filesystem.h>

#include <algorithm>

namespace vmlight {
namespace {

std::string with_slashes(std::string name)
{
    std::replace(name.begin(), name.end(), '\\', '/');
    return name;
}

std::string join(const std::string& folder, const std::string& name)
{
    const bool is_absolute = !name.empty() && name[0] == '/';
    return folder.empty() || is_absolute ? name : folder + (folder.back() == '/' ? "" : "/") + name;
}

} // namespace

std::string find_side_file(const std::string& folder, const std::string& name)
{
    const std::string path = with_slashes(name);
    for (const std::string& candidate : { join(folder, path), join(folder, path.substr(path.rfind('/') + 1)) })
        if (!name.empty() && OIIO::Filesystem::is_regular(candidate))
            return candidate;
    return "";
}

std::string side_path(const std::string& folder, const std::string& name)
{
    const std::string found = find_side_file(folder, name);
    return found.empty() && !name.empty() ? join(folder, with_slashes(name)) : found;
}

} // namespace vmlight
