// SPDX-License-Identifier: Apache-2.0
#include <vmlight/image/file_claims.h>

#include <vmlight/base/format.h>

#include <OpenImageIO/filesystem.h>
#include <OpenImageIO/strutil.h>

#include <algorithm>
#include <cmath>

namespace vmlight {

ClaimReader::ClaimReader(const std::string& path)
{
    if (!OIIO::Filesystem::is_regular(path)) // a pipe would block
        return;
    m_file = OIIO::Filesystem::fopen(path, "rb");
    m_size = m_file ? int64_t(OIIO::Filesystem::file_size(path)) : 0;
}

ClaimReader::~ClaimReader()
{
    if (m_file)
        std::fclose(m_file);
}

bool ClaimReader::read(void* bytes, int64_t count)
{
    if (count > left() || std::fread(bytes, 1, size_t(count), m_file) != size_t(count))
        return false;
    m_at += count;
    return true;
}

bool ClaimReader::skip(int64_t count)
{
    if (count > left() || OIIO::Filesystem::fseek(m_file, count, SEEK_CUR) != 0)
        return false;
    m_at += count;
    return true;
}

bool ClaimReader::read_until(char end, std::string& text, size_t most)
{
    text.clear();
    for (char c; text.size() <= most && read(&c, 1); text += c)
        if (c == end)
            return true;
    return false;
}

namespace {

/// A format, by the bytes that its files begin with.
struct Format
{
    OIIO::string_view magic;
    const char* reader;
    std::string (*fault)(ClaimReader& file);
};
constexpr Format kFormats[]
    = { { "\x76\x2f\x31\x01", "openexr", exr_claims_fault }, { "#?R", "hdr", radiance_claims_fault } };

const Format* format_of(ClaimReader& file)
{
    char magic[4];
    if (file.read(magic, 4))
        for (const Format& format : kFormats)
            if (OIIO::Strutil::starts_with(OIIO::string_view(magic, 4), format.magic))
                return &format;
    return nullptr;
}

} // namespace

std::string claims_fault(const std::string& path)
{
    ClaimReader file(path);
    const Format* format = format_of(file);
    return format ? format->fault(file) : "";
}

std::string reader_of(const std::string& path)
{
    ClaimReader file(path);
    const Format* format = format_of(file);
    return format ? format->reader : "";
}

std::string radiance_claims_fault(ClaimReader& file)
{
    constexpr size_t kLongestLine = 4096, kMostLines = 1000;
    std::string line;
    for (size_t i = 0; i < kMostLines && file.read_until('\n', line, kLongestLine); ++i) {
        int scanlines = 0, pixels = 0;
        char axes[2][3];
        // "-Y 512 +X 1024": the first axis counts scanlines.
        if (std::sscanf(line.c_str(), "%2[-+XY] %d %2[-+XY] %d", axes[0], &scanlines, axes[1], &pixels) != 4)
            continue;
        // A run is at most 127 pixels of one of four components, in two bytes. Scanlines shorter than 8 pixels or
        // longer than 32767 have no runs.
        const bool has_runs = pixels >= 8 && pixels <= 32767;
        const double shortest = has_runs ? 4 + 4 * 2 * std::ceil(pixels / 127.0) : 4.0 * pixels;
        const double least = shortest * scanlines;
        if (scanlines > 0 && pixels > 0 && least > double(file.left()) && 4.0 * pixels * scanlines > kSmallImage)
            return format("its header says {} scanlines of {} pixels, which take {:.0f} bytes or more; the file has {}",
                          scanlines, pixels, least, file.left());
        break;
    }
    return "";
}

} // namespace vmlight
