// SPDX-License-Identifier: Apache-2.0
#include <vmlight/base/format.h>
#include <vmlight/base/text_format.h>
#include <vmlight/mesh/import/format_checks.h>
#include <vmlight/mesh/import/ply_header.h>

#include <OpenImageIO/fmath.h>
#include <OpenImageIO/strutil.h>

#include <algorithm>
#include <cmath>
#include <cstring>

namespace vmlight {
namespace {

using namespace ply;

// Reads the numbers of the body in order. Each read is false past the end, or past the element's line.
class Body
{
public:
    Body(const std::string& bytes, const Header& header)
        : m_bytes(bytes)
        , m_at(std::min(header.body, bytes.size()))
        , m_line_begin(m_at)
        , m_line_end(m_at)
        , m_ascii(header.format == "ascii")
        , m_swapped(!m_ascii && (header.format == "binary_big_endian") == OIIO::littleendian())
    {
    }

    // Add what has been read since `begin` to `ranges`: in an ascii file, the line.
    void add_to(ByteRanges& ranges, size_t begin) const
    {
        ranges.add(m_ascii ? m_line_begin : begin, m_ascii ? m_line_end : m_at);
    }

    size_t at() const { return m_at; }

    bool next_element()
    {
        if (!m_ascii)
            return true;
        do { // skip blank lines
            m_at = m_line_begin = m_line_end;
            if (m_at >= m_bytes.size())
                return false;
            m_line_end = std::min(m_bytes.find('\n', m_at), m_bytes.size() - 1) + 1;
        } while (!find_word());
        return true;
    }

    bool read(const Type& type, double& value)
    {
        if (m_ascii) {
            if (!find_word())
                return false;
            char* rest = nullptr;
            value = OIIO::Strutil::strtod(&m_bytes[m_at], &rest);
            const bool any = rest != &m_bytes[m_at];
            m_at = size_t(rest - m_bytes.data());
            return any;
        }
        if (m_bytes.size() - m_at < type.bytes)
            return false;
        char raw[8];
        std::memcpy(raw, &m_bytes[m_at], type.bytes);
        if (m_swapped)
            std::reverse(raw, raw + type.bytes);
        m_at += type.bytes;
        value = number(type, raw);
        return true;
    }

private:
    bool find_word()
    {
        while (m_at < m_line_end && std::strchr(" \t\r\n", m_bytes[m_at]))
            ++m_at;
        return m_at < m_line_end;
    }
    template <class T> static double as(const char* raw)
    {
        T value;
        std::memcpy(&value, raw, sizeof(T));
        return double(value);
    }
    static double number(const Type& type, const char* raw)
    {
        if (type.kind == 'f')
            return type.bytes == 4 ? as<float>(raw) : as<double>(raw);
        if (type.kind == 's')
            return type.bytes == 1 ? as<int8_t>(raw) : type.bytes == 2 ? as<int16_t>(raw) : as<int32_t>(raw);
        return type.bytes == 1 ? as<uint8_t>(raw) : type.bytes == 2 ? as<uint16_t>(raw) : as<uint32_t>(raw);
    }

    const std::string& m_bytes;
    size_t m_at, m_line_begin, m_line_end;
    bool m_ascii, m_swapped;
};

// Read one property of element number `row`, and leave its last number in `value`. Every number of a face's list must
// be one of `vertices` vertices. Returns the error, or "".
std::string read_property(Body& body, const Element& element, const Property& property, size_t row, double vertices,
                          double& value)
{
    const auto cut = [&] { return format("PLY ends inside {} {} of {}", element.name, row, element.count); };
    double count = 1;
    if (property.count && !body.read(*property.count, count))
        return cut();
    const bool is_corners = element.name == "face" && property.count
        && (property.name == "vertex_indices" || property.name == "vertex_index");
    for (double i = 0; i < count; ++i) {
        if (!body.read(*property.type, value))
            return cut();
        if (is_corners && !(value >= 0 && value < vertices && value == std::floor(value)))
            return format("PLY face {} uses vertex {}, but there are only {}", row, value, vertices);
    }
    return "";
}

// 0, 1, 2 for x, y, z; else -1.
int axis_of(const Property& property)
{
    return property.name == "x" ? 0 : property.name == "y" ? 1 : property.name == "z" ? 2 : -1;
}

bool has_double_coordinates(const Element& element)
{
    return element.name == "vertex"
        && std::any_of(element.properties.begin(), element.properties.end(),
                       [](const Property& p) { return axis_of(p) >= 0 && p.type->bytes == 8; });
}

} // namespace

bool is_ply(const FileHead& head)
{
    return OIIO::Strutil::istarts_with(head.bytes, "ply");
}

Inspection inspect_ply(const std::string& bytes)
{
    Header header = read_header(bytes);
    Inspection result;
    result.error = header.error;
    double vertices = 0;
    for (const Element& element : header.elements)
        vertices = element.name == "vertex" ? double(element.count) : vertices;
    Body body(bytes, header);
    for (const Element& element : header.elements) {
        const bool is_exact = has_double_coordinates(element);
        for (size_t row = 0; row < element.count && result.error.empty() && !element.properties.empty(); ++row) {
            if (!body.next_element()) {
                result.error = format("PLY ends before {} {} of {}", element.name, row, element.count);
                break;
            }
            const size_t begin = body.at();
            Imath::V3d position(0);
            for (const Property& property : element.properties) {
                double value = 0;
                result.error = read_property(body, element, property, row, vertices, value);
                if (!result.error.empty())
                    break;
                if (const int axis = axis_of(property); axis >= 0)
                    position[axis] = value;
            }
            if (is_exact)
                result.exact_positions.push_back(position);
            if (element.is_mesh())
                body.add_to(header.mesh, begin);
        }
    }
    if (result.error.empty())
        result.replacement = header.mesh.text(bytes);
    result.error = shortened_line(result.error); // it quotes words of the header
    if (!result.error.empty() || !is_far_from_origin(result.exact_positions))
        result.exact_positions.clear();
    return result;
}

} // namespace vmlight
