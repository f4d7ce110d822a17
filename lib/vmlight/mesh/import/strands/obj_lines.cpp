// SPDX-License-Identifier: Apache-2.0
#include <vmlight/base/format.h>
#include <vmlight/mesh/import/obj_text.h>
#include <vmlight/mesh/import/strands/strand_format.h>

#include <cmath>
#include <vector>

namespace vmlight {
namespace {

using Imath::V3d;

class ObjLines
{
public:
    explicit ObjLines(Strands& dst)
        : m_strands(dst)
    {
    }

    bool parse(const std::string& text, std::string& error)
    {
        obj::Statements statements(text);
        obj::Statement statement {};
        while (m_error.empty() && statements.next(statement)) {
            if (statement.keyword == "v")
                vertex(statement);
            else if (statement.keyword == "l")
                line(statement);
        }
        if (m_error.empty() && m_strands.ends.empty())
            m_error = "no strands: it has no `l` statement";
        error = m_error;
        return error.empty();
    }

private:
    void vertex(const obj::Statement& statement)
    {
        OIIO::string_view rest = obj::without_comment(statement.arguments);
        V3d position(0);
        for (int axis = 0; axis < 3; ++axis) {
            TextNumber number;
            if (!parse_number(obj::next_word(rest), number)) {
                m_error = format("line {} is no vertex: {}", statement.line, obj::quoted(statement));
                return;
            }
            position[axis] = number.value;
        }
        m_vertices.push_back(position);
    }

    // The vertex that a word names, or -1, with m_error, if there is none. What follows a slash is a UV.
    int64_t index(OIIO::string_view word, const obj::Statement& statement)
    {
        TextNumber number;
        const bool good = parse_number(word.substr(0, word.find('/')), number);
        const double count = double(m_vertices.size());
        const double from_one = number.value < 0 ? count + 1 + number.value : number.value;
        if (good && from_one >= 1 && from_one <= count && from_one == std::floor(from_one))
            return int64_t(from_one) - 1;
        m_error = format("line {} uses vertex {}, but there are only {} before it", statement.line, word,
                         m_vertices.size());
        return -1;
    }

    void line(const obj::Statement& statement)
    {
        OIIO::string_view rest = obj::without_comment(statement.arguments);
        std::vector<int64_t> indices;
        for (OIIO::string_view word = obj::next_word(rest); !word.empty(); word = obj::next_word(rest)) {
            indices.push_back(index(word, statement));
            if (!m_error.empty())
                return;
        }
        if (indices.size() < 2) {
            m_error = format("line {} has fewer than two points: {}", statement.line, obj::quoted(statement));
            return;
        }
        const bool goes_on = !m_strands.ends.empty() && indices[0] == m_last;
        if (goes_on)
            m_strands.ends.pop_back();
        for (size_t i = goes_on; i < indices.size(); ++i)
            m_strands.points.push_back(m_vertices[size_t(indices[i])]);
        m_last = indices.back();
        end_strand(m_strands);
    }

    Strands& m_strands;
    std::string m_error;
    std::vector<V3d> m_vertices;
    int64_t m_last = -1; // vertex at the end of the strand before
};

} // namespace

bool has_obj_lines_alone(const StrandRequest& request)
{
    const std::string text = file_bytes(request.path);
    obj::Statements statements(text);
    obj::Statement statement {};
    bool has_lines = false;
    while (statements.next(statement)) {
        if (statement.keyword == "f")
            return false;
        has_lines = has_lines || statement.keyword == "l";
    }
    return has_lines;
}

bool read_obj_lines(Strands& dst, const StrandRequest& request, std::string& error)
{
    return ObjLines(dst).parse(file_bytes(request.path), error);
}

} // namespace vmlight
