// SPDX-License-Identifier: Apache-2.0
#include <vmlight/image/radiance_header.h>

#include <vmlight/base/format.h>

#include <OpenImageIO/filesystem.h>
#include <OpenImageIO/strutil.h>

#include <cstdint>
#include <cstdio>
#include <vector>

namespace vmlight {
namespace {

struct RadianceHeader
{
    std::vector<std::string> lines; ///< up to the empty one
    int width = 0, height = 0; ///< 0 if the resolution is not of the usual form
    std::string pixels; ///< their first bytes
    uint64_t pixel_bytes = 0;
};

// False for a file of any other kind.
bool read_header(RadianceHeader& header, const std::string& path)
{
    constexpr size_t kLongest = 1 << 16;
    if (!OIIO::Filesystem::is_regular(path))
        return false;
    std::string bytes(kLongest, '\0');
    bytes.resize(OIIO::Filesystem::read_bytes(path, bytes.data(), bytes.size()));
    if (!OIIO::Strutil::starts_with(bytes, "#?"))
        return false;
    size_t at = 0;
    const auto next_line = [&] {
        const size_t end = bytes.find('\n', at);
        std::string line = bytes.substr(at, end - at);
        at = end == std::string::npos ? bytes.size() : end + 1;
        return line;
    };
    while (at < bytes.size()) {
        header.lines.push_back(next_line());
        if (header.lines.back().empty())
            break;
    }
    char y = 0, x = 0;
    const std::string resolution = next_line();
    if (std::sscanf(resolution.c_str(), "%cY %d %cX %d", &y, &header.height, &x, &header.width) != 4)
        header.width = header.height = 0;
    header.pixels = bytes.substr(at, 4);
    header.pixel_bytes = OIIO::Filesystem::file_size(path) - at;
    return true;
}

std::vector<std::string> values_of(const RadianceHeader& header, const std::string& name)
{
    std::vector<std::string> values;
    for (const std::string& line : header.lines)
        if (OIIO::Strutil::starts_with(line, name + "="))
            values.emplace_back(OIIO::Strutil::strip(line.substr(name.size() + 1)));
    return values;
}

bool has_new_encoding(const RadianceHeader& header)
{
    const auto byte = [&](size_t i) { return int(static_cast<unsigned char>(header.pixels[i])); };
    return header.pixels.size() == 4 && byte(0) == 2 && byte(1) == 2 && byte(2) * 256 + byte(3) == header.width;
}

} // namespace

std::string radiance_fault(const std::string& path)
{
    RadianceHeader header;
    if (!read_header(header, path))
        return "";
    for (const std::string& name : values_of(header, "FORMAT"))
        if (OIIO::Strutil::icontains(name, "xyze"))
            return "a Radiance picture of XYZE pixels cannot be read; convert it to RGBE with ra_xyze -r";
    // A run makes the pixels fewer than there are; without runs the old encoding is the plain one.
    const uint64_t plain
        = 4 * uint64_t(header.width > 0 ? header.width : 0) * uint64_t(header.height > 0 ? header.height : 0);
    if (plain && !has_new_encoding(header) && header.pixel_bytes < plain)
        return format(
            "a Radiance picture of old run-length encoding, or cut off: {} bytes of pixels where {}x{} plain ones "
            "take {}; if it is whole, write it again with another program",
            header.pixel_bytes, header.width, header.height, plain);
    return "";
}

std::string unapplied_radiance_header(const std::string& path)
{
    RadianceHeader header;
    std::string found;
    if (read_header(header, path))
        for (const char* name : { "EXPOSURE", "GAMMA" })
            for (const std::string& value : values_of(header, name)) {
                const double number = OIIO::Strutil::strtod(value.c_str());
                if (number != 1)
                    found += format("{}{}={}", found.empty() ? "" : ", ", name, value);
            }
    return found.empty() ? "" : format("light is used as stored: {} in the header is not divided out", found);
}

} // namespace vmlight
