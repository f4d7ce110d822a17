// SPDX-License-Identifier: Apache-2.0
#include <vmlight/mesh_file_fault.h>

#include <OpenImageIO/filesystem.h>
#include <OpenImageIO/strutil.h>

#include <vector>

namespace vmlight {

std::string mesh_file_fault(const std::string& path)
{
    constexpr size_t kLongestHeader = 1 << 16;
    std::string start(kLongestHeader, '\0');
    start.resize(OIIO::Filesystem::read_bytes(path, start.data(), start.size()));
    if (!OIIO::Strutil::starts_with(start, "ply"))
        return "";
    const size_t end = start.find("end_header");
    if (end == std::string::npos)
        return "its PLY header has no end";
    const double bytes = double(OIIO::Filesystem::file_size(path));
    for (const std::string& line : OIIO::Strutil::splits(start.substr(0, end), "\n")) {
        const std::vector<std::string> words = OIIO::Strutil::splits(line);
        if (words.size() < 3 || words[0] != "element")
            continue;
        char* rest = nullptr;
        const double count = OIIO::Strutil::strtod(words[2].c_str(), &rest);
        if (*rest != '\0' || !(count >= 0 && count <= bytes))
            return OIIO::Strutil::fmt::format("its PLY header promises {} of element \"{}\" in a file of {} bytes",
                                              words[2], words[1], bytes);
    }
    return "";
}

} // namespace vmlight
