// SPDX-License-Identifier: Apache-2.0
#include <vmlight/image/file_claims.h>

#include <vmlight/image/radiance_header.h>

#include <OpenImageIO/filesystem.h>
#include <OpenImageIO/string_view.h>

#include <cstdio>

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
constexpr Format kFormats[] = { { "\x76\x2f\x31\x01", "openexr", exr_claims_fault }, { "#?", "hdr", radiance_fault } };

} // namespace

FileHeader inspect_header(const std::string& path)
{
    ClaimReader file(path);
    std::string begin;
    for (char c; begin.size() < 4 && file.read(&c, 1);) {
        begin += c;
        for (const Format& format : kFormats)
            if (begin == format.magic)
                return { format.reader, format.fault(file) };
    }
    return {};
}

std::string claims_fault(const std::string& path)
{
    return inspect_header(path).fault;
}

} // namespace vmlight
