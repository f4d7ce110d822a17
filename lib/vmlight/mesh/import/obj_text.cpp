// SPDX-License-Identifier: Apache-2.0
#include <vmlight/base/format.h>
#include <vmlight/base/text_format.h>
#include <vmlight/mesh/import/obj_text.h>

#include <OpenImageIO/strutil.h>

#include <algorithm>

namespace vmlight::obj {
namespace {

using OIIO::string_view;

bool is_blank(char c)
{
    return c == ' ' || c == '\t';
}

string_view stripped(string_view text)
{
    while (!text.empty() && is_blank(text.front()))
        text.remove_prefix(1);
    while (!text.empty() && is_blank(text.back()))
        text.remove_suffix(1);
    return text;
}

// A path in a comment may end in a backslash too.
bool is_continued(string_view line)
{
    return !line.empty() && line.back() == '\\' && line.find('#') == string_view::npos;
}

// As in 1.#QNAN, 1.#IND, 1.#SNAN and 1.#INF, which old C libraries write.
bool is_in_number(string_view text, size_t sign)
{
    const string_view next = text.substr(std::min(sign + 1, text.size()), 1);
    return sign > 0 && text[sign - 1] == '.' && (next == "Q" || next == "I" || next == "S");
}

} // namespace

string_view next_word(string_view& text)
{
    size_t begin = 0, end = 0;
    while (begin < text.size() && is_blank(text[begin]))
        ++begin;
    for (end = begin; end < text.size() && !is_blank(text[end]);)
        ++end;
    const string_view word = text.substr(begin, end - begin);
    text.remove_prefix(end);
    return word;
}

string_view without_comment(string_view arguments)
{
    size_t sign = arguments.find('#');
    while (sign != string_view::npos && is_in_number(arguments, sign))
        sign = arguments.find('#', sign + 1);
    return stripped(arguments.substr(0, sign));
}

std::string name_in(string_view arguments)
{
    for (size_t sign = arguments.find('#'); sign != string_view::npos; sign = arguments.find('#', sign + 1)) {
        const bool ends_word = sign + 1 == arguments.size() || is_blank(arguments[sign + 1]);
        if (ends_word && sign > 0 && is_blank(arguments[sign - 1]))
            return stripped(arguments.substr(0, sign));
    }
    return stripped(arguments);
}

std::string quoted(const Statement& statement)
{
    return shortened_line(format("\"{} {}\"", statement.keyword, statement.arguments));
}

Statements::Statements(const std::string& text)
    : m_rest(text)
{
    OIIO::Strutil::parse_prefix(m_rest, "\xef\xbb\xbf");
}

string_view Statements::next_line()
{
    ++m_line;
    size_t end = 0;
    while (end < m_rest.size() && m_rest[end] != '\n' && m_rest[end] != '\r')
        ++end;
    const string_view line = stripped(m_rest.substr(0, end));
    const bool is_crlf = end + 1 < m_rest.size() && m_rest[end] == '\r' && m_rest[end + 1] == '\n';
    m_rest.remove_prefix(std::min(m_rest.size(), end + (is_crlf ? 2 : 1)));
    return line;
}

bool Statements::next(Statement& statement)
{
    while (!m_rest.empty()) {
        string_view line = next_line();
        statement.line = m_line;
        if (is_continued(line)) {
            m_joined.clear();
            for (; is_continued(line); line = next_line()) {
                m_joined.append(line.data(), line.size() - 1) += ' ';
                if (m_rest.empty()) {
                    line = "";
                    break;
                }
            }
            m_joined.append(line.data(), line.size());
            line = stripped(m_joined);
        }
        statement.keyword = next_word(line);
        statement.arguments = stripped(line);
        if (!statement.keyword.empty() && statement.keyword[0] != '#')
            return true;
    }
    return false;
}

} // namespace vmlight::obj
