// SPDX-License-Identifier: Apache-2.0
#include <vmlight/image/radiance_header.h>

#include <vmlight/base/format.h>
#include <vmlight/image/file_claims.h>

#include <OpenImageIO/strutil.h>

#include <cmath>
#include <cstdint>
#include <cstdio>
#include <vector>

namespace vmlight {
namespace {

struct RadianceHeader
{
    std::vector<std::string> entries; ///< lines before the resolution
    int scanlines = 0, pixels = 0; ///< in each; 0 if there is no resolution
    bool rows = false; ///< scanlines are rows, not columns
    unsigned char first[4] {}; ///< bytes of pixels
    int64_t pixel_bytes = 0;
};

// `file` is read up to the end of "#?".
RadianceHeader read_header(ClaimReader& file)
{
    constexpr size_t kLongestLine = 4096, kMostLines = 1000;
    RadianceHeader header;
    std::string line;
    for (size_t i = 0; i < kMostLines && file.read_until('\n', line, kLongestLine); ++i) {
        int scanlines = 0, pixels = 0;
        char axes[2][3];
        // "-Y 512 +X 1024": the first axis counts scanlines.
        if (std::sscanf(line.c_str(), "%2[-+XY] %d %2[-+XY] %d", axes[0], &scanlines, axes[1], &pixels) != 4) {
            header.entries.push_back(line);
            continue;
        }
        if (scanlines > 0 && pixels > 0) {
            header.scanlines = scanlines;
            header.pixels = pixels;
        }
        header.rows = axes[0][1] == 'Y' && axes[1][1] == 'X';
        header.pixel_bytes = file.left();
        file.read(header.first, 4);
        break;
    }
    return header;
}

std::vector<std::string> values_of(const RadianceHeader& header, const std::string& name)
{
    std::vector<std::string> values;
    for (const std::string& line : header.entries)
        if (OIIO::Strutil::starts_with(line, name + "="))
            values.emplace_back(OIIO::Strutil::strip(line.substr(name.size() + 1)));
    return values;
}

bool has_new_encoding(const RadianceHeader& header)
{
    return header.first[0] == 2 && header.first[1] == 2 && header.first[2] * 256 + header.first[3] == header.pixels;
}

// The fewest bytes that the pixels can take: a run is at most 127 pixels of one of four components, in two bytes.
// Scanlines shorter than 8 pixels or longer than 32767 have no runs.
double least_bytes(const RadianceHeader& header)
{
    const bool has_runs = header.pixels >= 8 && header.pixels <= 32767;
    return header.scanlines * (has_runs ? 4 + 4 * 2 * std::ceil(header.pixels / 127.0) : 4.0 * header.pixels);
}

} // namespace

std::string radiance_fault(ClaimReader& file)
{
    const RadianceHeader header = read_header(file);
    const double least = least_bytes(header), plain = 4.0 * header.scanlines * header.pixels;
    if (least > double(header.pixel_bytes) && plain > kSmallImage)
        return format("its header says {} scanlines of {} pixels, which take {:.0f} bytes or more; the file has {}",
                      header.scanlines, header.pixels, least, header.pixel_bytes);
    for (const std::string& name : values_of(header, "FORMAT"))
        if (OIIO::Strutil::icontains(name, "xyze"))
            return "a Radiance picture of XYZE pixels cannot be read; convert it to RGBE with ra_xyze -r";
    // A run makes the pixels fewer than there are; without runs the old encoding is the plain one.
    if (header.rows && !has_new_encoding(header) && double(header.pixel_bytes) < plain)
        return format(
            "a Radiance picture of old run-length encoding, or cut off: {} bytes of pixels where {}x{} plain ones "
            "take {:.0f}; if it is whole, write it again with another program",
            header.pixel_bytes, header.pixels, header.scanlines, plain);
    return "";
}

std::string unapplied_radiance_header(const std::string& path)
{
    ClaimReader file(path);
    char magic[2];
    if (!file.read(magic, 2) || OIIO::string_view(magic, 2) != "#?")
        return "";
    const RadianceHeader header = read_header(file);
    std::string found;
    for (const char* name : { "EXPOSURE", "GAMMA" })
        for (const std::string& value : values_of(header, name)) {
            const double number = OIIO::Strutil::strtod(value.c_str());
            if (number != 1)
                found += format("{}{}={}", found.empty() ? "" : ", ", name, value);
        }
    return found.empty() ? "" : format("light is used as stored: {} in the header is not divided out", found);
}

} // namespace vmlight
