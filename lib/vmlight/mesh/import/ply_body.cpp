// SPDX-License-Identifier: Apache-2.0
#include <vmlight/mesh/import/ply_body.h>

#include <OpenImageIO/fmath.h>

#include <algorithm>
#include <cstdint>
#include <cstring>

namespace vmlight::ply {
namespace {

bool is_blank(char c)
{
    return c == ' ' || c == '\t' || c == '\r' || c == '\n';
}

template <class T> double as(const char* raw)
{
    T value;
    std::memcpy(&value, raw, sizeof(T));
    return double(value);
}

double number_of(const Type& type, const char* raw)
{
    if (type.kind == 'f')
        return type.bytes == 4 ? as<float>(raw) : as<double>(raw);
    if (type.kind == 's')
        return type.bytes == 1 ? as<int8_t>(raw) : type.bytes == 2 ? as<int16_t>(raw) : as<int32_t>(raw);
    return type.bytes == 1 ? as<uint8_t>(raw) : type.bytes == 2 ? as<uint16_t>(raw) : as<uint32_t>(raw);
}

} // namespace

Body::Body(const std::string& bytes, const Header& header)
    : m_bytes(bytes)
    , m_at(std::min(header.body, bytes.size()))
    , m_line_end(m_at)
    , m_ascii(header.format == "ascii")
    , m_swapped(!m_ascii && (header.format == "binary_big_endian") == OIIO::littleendian())
{
}

bool Body::next_element()
{
    if (!m_ascii)
        return true;
    do { // skip blank lines
        m_at = m_line_end;
        if (m_at >= m_bytes.size())
            return false;
        m_line_end = std::min(m_bytes.find('\n', m_at), m_bytes.size() - 1) + 1;
    } while (!find_word());
    return true;
}

Reading Body::read(const Type& type, TextNumber& number)
{
    if (m_ascii) {
        if (!find_word())
            return Reading::end;
        const size_t begin = m_at;
        while (m_at < m_line_end && !is_blank(m_bytes[m_at]))
            ++m_at;
        if (!parse_number(OIIO::string_view(&m_bytes[begin], m_at - begin), number))
            return Reading::no_number;
        if (type.bytes != 4 || type.kind != 'f')
            number.rounded = nearest_float(number.value);
        return Reading::good;
    }
    if (left() < type.bytes)
        return Reading::end;
    number = number_at(type, 0);
    skip(type.bytes);
    return Reading::good;
}

TextNumber Body::number_at(const Type& type, size_t offset) const
{
    char raw[8];
    std::memcpy(raw, here() + offset, type.bytes);
    if (m_swapped)
        std::reverse(raw, raw + type.bytes);
    const double value = number_of(type, raw);
    return { value, nearest_float(value) };
}

bool Body::find_word()
{
    while (m_at < m_line_end && is_blank(m_bytes[m_at]))
        ++m_at;
    return m_at < m_line_end;
}

} // namespace vmlight::ply
