// SPDX-License-Identifier: Apache-2.0
#include <vmlight/mesh/import/ply.h>

#include <vmlight/base/words.h>

#include <OpenImageIO/fmath.h>
#include <OpenImageIO/strutil.h>

#include <algorithm>
#include <cmath>
#include <cstring>

namespace vmlight {
namespace {

using OIIO::Strutil::fmt::format;
using Words = std::vector<std::string>;

struct Type
{
    const char *name, *other_name;
    size_t bytes;
    char kind; // signed, unsigned, floating
};
constexpr Type kTypes[]
    = { { "char", "int8", 1, 's' },     { "uchar", "uint8", 1, 'u' },   { "short", "int16", 2, 's' },
        { "ushort", "uint16", 2, 'u' }, { "int", "int32", 4, 's' },     { "uint", "uint32", 4, 'u' },
        { "float", "float32", 4, 'f' }, { "double", "float64", 8, 'f' } };

const Type* find_type(const std::string& name)
{
    const auto type = std::find_if(std::begin(kTypes), std::end(kTypes),
                                   [&](const Type& t) { return name == t.name || name == t.other_name; });
    return type == std::end(kTypes) ? nullptr : type;
}

struct Property
{
    std::string name;
    const Type* type;
    const Type* count = nullptr; // of a list
};

struct Element
{
    std::string name;
    size_t count;
    std::vector<Property> properties;
};

// Parts of the file, in its order.
class Parts
{
public:
    void add(size_t begin, size_t end)
    {
        if (!m_parts.empty() && m_parts.back().second == begin)
            m_parts.back().second = end;
        else if (begin < end)
            m_parts.emplace_back(begin, end);
    }
    // "" if they are the file, less what follows them.
    std::string text(const std::string& bytes) const
    {
        std::string text;
        if (m_parts.size() > 1 || (m_parts.size() == 1 && m_parts[0].first > 0))
            for (const auto& [begin, end] : m_parts)
                text.append(bytes, begin, end - begin);
        return text;
    }

private:
    std::vector<std::pair<size_t, size_t>> m_parts;
};

// What triangles are made of. Of all else assimp 5.2 reads some as if it were vertices, and loses its place after some.
bool is_wanted(const Element& element)
{
    return element.name == "vertex" || element.name == "face" || element.name == "tristrips";
}

struct Header
{
    std::string format, fault;
    std::vector<Element> elements;
    Parts wanted;
    size_t body = 0;
};

// "" or why the line cannot be followed.
std::string add_line(Header& header, const Words& words, size_t bytes)
{
    if (words.size() > 1 && words[0] == "format")
        header.format = words[1];
    if (words.size() > 2 && words[0] == "element") {
        char* rest = nullptr;
        const double count = OIIO::Strutil::strtod(words[2].c_str(), &rest);
        if (*rest != '\0' || !(count >= 0 && count <= double(bytes)))
            return format("its PLY header promises {} of element \"{}\" in a file of {} bytes", words[2], words[1],
                          bytes);
        header.elements.push_back({ words[1], size_t(count), {} });
    }
    if (words.empty() || words[0] != "property")
        return "";
    const bool is_list = words.size() == 5 && words[1] == "list";
    Property property { words.back(), words.size() > 2 ? find_type(words[is_list ? 3 : 1]) : nullptr };
    property.count = is_list ? find_type(words[2]) : nullptr;
    if (header.elements.empty() || !property.type || (is_list && !property.count) || (!is_list && words.size() != 3))
        return format("its PLY header has a property that is none: \"{}\"", OIIO::Strutil::join(words, " "));
    header.elements.back().properties.push_back(property);
    return "";
}

Header read_header(const std::string& bytes)
{
    Header header;
    for (size_t begin = 0; begin < bytes.size();) {
        const size_t end = std::min(bytes.find('\n', begin), bytes.size());
        const Words words = OIIO::Strutil::splits(bytes.substr(begin, end - begin));
        header.body = std::min(end + 1, bytes.size());
        const bool is_end = !words.empty() && words[0] == "end_header";
        if (!is_end)
            header.fault = add_line(header, words, bytes.size());
        if (is_end || (!words.empty() && (header.elements.empty() || is_wanted(header.elements.back()))))
            header.wanted.add(begin, header.body);
        if (is_end || !header.fault.empty())
            return header;
        begin = end + 1;
    }
    header.fault = "its PLY header has no end";
    return header;
}

// The numbers of the body, one after the other. Each read is false past the end, or past the element's line.
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

    // Add what has been read of the element to `parts`: its line, of an ascii one.
    void add_to(Parts& parts, size_t begin) const
    {
        parts.add(m_ascii ? m_line_begin : begin, m_ascii ? m_line_end : m_at);
    }

    size_t at() const { return m_at; }

    bool next_element()
    {
        if (!m_ascii)
            return true;
        do { // blank lines are passed over
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

// Read one property of element number `row`; the last number of it is left in `value`. Of a face's list every number
// must be a vertex's, of which there are `vertices`.
std::string read_property(Body& body, const Element& element, const Property& property, size_t row, double vertices,
                          double& value)
{
    const auto cut = [&] { return format("its PLY ends within {} {} of {}", element.name, row, element.count); };
    double count = 1;
    if (property.count && !body.read(*property.count, count))
        return cut();
    const bool is_corners = element.name == "face" && property.count
        && (property.name == "vertex_indices" || property.name == "vertex_index");
    for (double i = 0; i < count; ++i) {
        if (!body.read(*property.type, value))
            return cut();
        if (is_corners && !(value >= 0 && value < vertices && value == std::floor(value)))
            return format("its PLY face {} has vertex {}, of {}", row, value, vertices);
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

MeshFile inspect_ply(const std::string& bytes)
{
    Header header = read_header(bytes);
    MeshFile file;
    file.fault = header.fault;
    double vertices = 0;
    for (const Element& element : header.elements)
        vertices = element.name == "vertex" ? double(element.count) : vertices;
    Body body(bytes, header);
    for (const Element& element : header.elements) {
        const bool keeps = has_double_coordinates(element);
        for (size_t row = 0; row < element.count && file.fault.empty() && !element.properties.empty(); ++row) {
            if (!body.next_element()) {
                file.fault = format("its PLY ends before {} {} of {}", element.name, row, element.count);
                break;
            }
            const size_t begin = body.at();
            Imath::V3d place(0);
            for (const Property& property : element.properties) {
                double value = 0;
                file.fault = read_property(body, element, property, row, vertices, value);
                if (!file.fault.empty())
                    break;
                if (const int axis = axis_of(property); axis >= 0)
                    place[axis] = value;
            }
            if (keeps)
                file.positions.push_back(place);
            if (is_wanted(element))
                body.add_to(header.wanted, begin);
        }
    }
    if (file.fault.empty())
        file.stand_in = header.wanted.text(bytes);
    file.fault = reason_line(file.fault); // it quotes the header's words
    if (!file.fault.empty() || !lie_far_from_origin(file.positions))
        file.positions.clear();
    return file;
}

} // namespace vmlight
