// SPDX-License-Identifier: Apache-2.0
#include <vmlight/mesh/import/ply_file.h>

#include <vmlight/base/format.h>
#include <vmlight/base/text_format.h>
#include <vmlight/mesh/import/ply_rows.h>

#include <algorithm>
#include <array>
#include <limits>
#include <optional>

namespace vmlight::ply {
namespace {

using Imath::V2f;
using Imath::V3d;
using Imath::V3f;

class Parser
{
public:
    Parser(File& dst, const std::string& bytes)
        : m_file(dst)
        , m_header(read_header(bytes))
        , m_body(bytes, m_header)
        , m_body_bytes(bytes.size() - std::min(m_header.body, bytes.size()))
    {
        dst.textures = m_header.textures;
        for (const Element& element : m_header.elements)
            m_vertex_count += element.name == "vertex" ? element.count : 0;
    }

    // Why the file is refused, or "".
    std::string parse();

private:
    // Read the numbers of a property into m_numbers. Returns the error, or "".
    std::string read_property(const Element& element, const Property& property, size_t row);
    std::string read_element(const Element& element);
    size_t rows_of(const Element& element) const;
    std::string begin_vertices(const Element& element, const Roles& roles);
    void add_vertex();
    void reserve_faces(const Element& element);
    // Read an element as EvenRows. False, with nothing read, if it is not of these, or a corner is invalid.
    bool read_even_rows(const Element& element, const Roles& roles);
    std::string add_corners(const Element& element, size_t row);
    std::string add_face(size_t row);
    void add_strips();

    File& m_file;
    const Header m_header;
    Body m_body;
    const size_t m_body_bytes;
    size_t m_vertex_count = 0;
    VertexParts m_parts;
    std::vector<TextNumber> m_numbers; // of a property
    std::array<TextNumber, 8> m_vertex; // by role
    std::vector<int64_t> m_corners; // of a face or strip
    std::vector<float> m_uvs; // of a face
    int32_t m_texture = -1; // of a face
};

std::string Parser::read_property(const Element& element, const Property& property, size_t row)
{
    const auto failure = [&](Reading reading) {
        return reading == Reading::end
            ? format("PLY ends inside {} {} of {}", element.name, row, element.count)
            : format("PLY {} {} has something other than a number as {}", element.name, row, property.name);
    };
    m_numbers.clear();
    TextNumber number;
    double count = 1;
    if (property.count) {
        if (const Reading reading = m_body.read(*property.count, number); reading != Reading::good)
            return failure(reading);
        count = number.value;
    }
    for (double i = 0; i < count; ++i) {
        if (const Reading reading = m_body.read(*property.type, number); reading != Reading::good)
            return failure(reading);
        m_numbers.push_back(number);
    }
    return "";
}

// Rows of an element, but no more than the file can hold, whatever its header says. Reserved for, as vectors that grow
// hold all twice while they move.
size_t Parser::rows_of(const Element& element) const
{
    size_t least = 0;
    for (const Property& property : element.properties)
        least += m_header.format == "ascii" ? 1 : property.count ? property.count->bytes : property.type->bytes;
    return std::min(element.count, m_body_bytes / std::max<size_t>(1, least));
}

std::string Parser::begin_vertices(const Element& element, const Roles& roles)
{
    if (!has_role(roles, kX) || !has_role(roles, kY)) // z is 0 in drawings
        return "PLY vertices have no x and y";
    m_parts = VertexParts(element, roles);
    const size_t rows = rows_of(element);
    m_file.positions.reserve(rows);
    m_file.exact_positions.reserve(m_parts.has_doubles ? rows : 0);
    m_file.normals.reserve(m_parts.has_normals ? rows : 0);
    m_file.uvs.reserve(m_parts.has_uvs ? rows : 0);
    return "";
}

void Parser::add_vertex()
{
    const auto& n = m_vertex;
    m_file.positions.push_back(V3f(n[kX].rounded, n[kY].rounded, n[kZ].rounded));
    if (m_parts.has_doubles)
        m_file.exact_positions.push_back(V3d(n[kX].value, n[kY].value, n[kZ].value));
    if (m_parts.has_normals)
        m_file.normals.push_back(V3f(n[kNormalX].rounded, n[kNormalY].rounded, n[kNormalZ].rounded));
    if (m_parts.has_uvs)
        m_file.uvs.push_back(V2f(n[kU].rounded, n[kV].rounded));
}

// As if all faces had as many corners as the first. Each corner takes a byte of the file at least.
void Parser::reserve_faces(const Element& element)
{
    const size_t rows = rows_of(element);
    m_file.ends.reserve(rows);
    m_file.corners.reserve(std::min(rows * m_corners.size(), m_body_bytes));
}

std::string Parser::add_corners(const Element& element, size_t row)
{
    m_corners.clear();
    const bool is_strip = element.name == "tristrips";
    for (const TextNumber& number : m_numbers) {
        const double vertex = number.value;
        const bool is_restart = is_strip && vertex == -1;
        if (!is_restart && !is_vertex_index(vertex, m_vertex_count))
            return format("PLY {} {} uses vertex {}, but there are only {}", element.name, row, vertex, m_vertex_count);
        m_corners.push_back(int64_t(vertex));
    }
    return "";
}

std::string Parser::add_face(size_t row)
{
    if (!m_uvs.empty() && m_uvs.size() != 2 * m_corners.size())
        return format("PLY face {} has {} numbers as texture coordinates, but its {} corners need {}", row,
                      m_uvs.size(), m_corners.size(), 2 * m_corners.size());
    const float nan = std::numeric_limits<float>::quiet_NaN();
    if (!m_uvs.empty())
        m_file.corner_uvs.resize(m_file.corners.size(), V2f(nan, nan));
    for (size_t i = 0; i < m_uvs.size(); i += 2)
        m_file.corner_uvs.push_back(V2f(m_uvs[i], m_uvs[i + 1]));
    if (m_texture >= 0)
        m_file.face_textures.resize(m_file.ends.size(), -1);
    if (m_texture >= 0)
        m_file.face_textures.push_back(m_texture);
    m_file.corners.insert(m_file.corners.end(), m_corners.begin(), m_corners.end());
    m_file.ends.push_back(uint32_t(m_file.corners.size()));
    return "";
}

// Each vertex behind the first two makes a triangle with them; every second one is turned over.
void Parser::add_strips()
{
    size_t begin = 0;
    for (size_t i = 0; i < m_corners.size(); ++i) {
        if (m_corners[i] < 0) {
            begin = i + 1;
        } else if (i >= begin + 2) {
            const bool is_turned = (i - begin) % 2 == 1;
            m_file.corners.push_back(uint32_t(m_corners[i - (is_turned ? 1 : 2)]));
            m_file.corners.push_back(uint32_t(m_corners[i - (is_turned ? 2 : 1)]));
            m_file.corners.push_back(uint32_t(m_corners[i]));
            m_file.ends.push_back(uint32_t(m_file.corners.size()));
        }
    }
}

bool Parser::read_even_rows(const Element& element, const Roles& roles)
{
    if (element.name == "tristrips" || has_role(roles, kUvs) || has_role(roles, kTexture))
        return false;
    const std::optional<EvenRows> rows = EvenRows::find(element, m_body);
    if (!rows || (element.name == "face" && !read_faces(m_file, *rows, roles, m_vertex_count)))
        return false;
    if (element.name == "vertex")
        read_vertices(m_file, *rows, roles, m_parts);
    m_body.skip(rows->bytes());
    return true;
}

std::string Parser::read_element(const Element& element)
{
    const Roles roles = roles_of(element);
    const bool is_vertex = element.name == "vertex", is_face = element.name == "face";
    if (is_vertex && element.count > 0)
        if (const std::string error = begin_vertices(element, roles); !error.empty())
            return error;
    if (read_even_rows(element, roles))
        return "";
    for (size_t row = 0; row < element.count && !element.properties.empty(); ++row) {
        if (!m_body.next_element())
            return format("PLY ends before {} {} of {}", element.name, row, element.count);
        m_corners.clear();
        m_uvs.clear();
        m_texture = -1;
        for (size_t i = 0; i < roles.size(); ++i) {
            std::string error = read_property(element, element.properties[i], row);
            if (error.empty() && roles[i] == kCorners)
                error = add_corners(element, row);
            if (!error.empty())
                return error;
            if (roles[i] <= kV)
                m_vertex[roles[i]] = m_numbers[0];
            if (roles[i] == kUvs)
                for (const TextNumber& number : m_numbers)
                    m_uvs.push_back(number.rounded);
            if (roles[i] == kTexture && m_numbers[0].value >= 0 && m_numbers[0].value < double(m_file.textures.size()))
                m_texture = int32_t(m_numbers[0].value);
        }
        if (is_face && row == 0)
            reserve_faces(element);
        if (is_vertex)
            add_vertex();
        else if (is_face)
            if (const std::string error = add_face(row); !error.empty())
                return error;
        if (element.name == "tristrips")
            add_strips();
    }
    return "";
}

std::string Parser::parse()
{
    std::string error = m_header.error;
    const auto is_vertex = [](const Element& element) { return element.name == "vertex"; };
    if (error.empty() && std::count_if(m_header.elements.begin(), m_header.elements.end(), is_vertex) > 1)
        error = "invalid PLY header: more than one element \"vertex\"";
    for (const Element& element : m_header.elements)
        if (error.empty())
            error = read_element(element);
    const float nan = std::numeric_limits<float>::quiet_NaN();
    if (!m_file.corner_uvs.empty())
        m_file.corner_uvs.resize(m_file.corners.size(), V2f(nan, nan));
    if (!m_file.face_textures.empty())
        m_file.face_textures.resize(m_file.ends.size(), -1);
    return shortened_line(error); // it quotes words of the header
}

} // namespace

bool parse(File& dst, const std::string& bytes, std::string& error)
{
    error = Parser(dst, bytes).parse();
    return error.empty();
}

} // namespace vmlight::ply
