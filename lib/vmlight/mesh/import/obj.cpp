// SPDX-License-Identifier: Apache-2.0
#include <vmlight/base/words.h>
#include <vmlight/mesh/import/format_checks.h>

#include <OpenImageIO/strutil.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <cstring>

namespace vmlight {
namespace {

using Imath::V3d;
using OIIO::Strutil::fmt::format;

// Visit the begin and end of each line, until a visit returns false.
template <class Visit> void each_line(const std::string& text, Visit&& visit)
{
    for (size_t begin = 0; begin < text.size();) {
        const size_t end = std::min(text.find_first_of("\r\n", begin), text.size());
        if (!visit(begin, end))
            return;
        begin = end + (text.compare(end, 2, "\r\n") == 0 ? 2 : 1);
    }
}

// Does the line start with the keyword and a blank?
bool has_keyword(const char* line, OIIO::string_view keyword)
{
    const char after = std::equal(keyword.begin(), keyword.end(), line) ? line[keyword.size()] : 0;
    return after == ' ' || after == '\t';
}

// Up to `max_count` numbers from `at` on. False if something else than a comment follows them on the line.
bool parse_numbers(const char* at, size_t max_count, std::vector<double>& numbers)
{
    numbers.clear();
    while (numbers.size() < max_count) {
        while (*at == ' ' || *at == '\t')
            ++at;
        if (*at == '\0' || *at == '\n' || *at == '\r' || *at == '#')
            return true;
        char* rest = nullptr;
        numbers.push_back(OIIO::Strutil::strtod(at, &rest));
        if (rest == at) {
            numbers.pop_back();
            return false;
        }
        at = rest;
    }
    return false;
}

// A vertex of 3 numbers, 4 (homogeneous) or 6 (with a colour), as assimp reads it.
bool parse_vertex(const char* at, std::vector<double>& numbers, V3d& vertex)
{
    if (!parse_numbers(at, 7, numbers) || (numbers.size() != 3 && numbers.size() != 4 && numbers.size() != 6))
        return false;
    vertex = V3d(numbers[0], numbers[1], numbers[2]);
    if (numbers.size() == 4)
        vertex /= numbers[3];
    return true;
}

std::string first_words(const std::string& line, size_t count)
{
    std::vector<std::string> words = OIIO::Strutil::splits(line);
    words.resize(std::min(words.size(), count));
    return OIIO::Strutil::join(words, " ");
}

// Drop what assimp misreads: comments after numbers, alpha after a vertex colour, a third texture coordinate that is
// not finite.
void sanitize_line(std::string& line)
{
    const bool is_vertex = has_keyword(line.c_str(), "v"), is_uv = has_keyword(line.c_str(), "vt");
    if (!is_vertex && !is_uv)
        return;
    line.resize(std::min(line.find('#'), line.size()));
    std::vector<double> numbers;
    parse_numbers(line.c_str() + (is_uv ? 2 : 1), 8, numbers);
    if (is_vertex && numbers.size() == 7)
        line = first_words(line, 4);
    if (is_uv && numbers.size() == 3 && !std::isfinite(numbers[2]))
        line = first_words(line, 3);
}

// The text as assimp reads it correctly, one statement per line and lines numbered as before; "" if nothing differs.
std::string sanitized(const std::string& text)
{
    std::string clean, line;
    bool differs = false;
    size_t continued = 0; // lines joined with the next so far
    const size_t byte_order_mark = text.compare(0, 3, "\xef\xbb\xbf") == 0 ? 3 : 0;
    each_line(text, [&](size_t begin, size_t end) {
        begin += begin == 0 ? byte_order_mark : 0;
        const size_t first = std::min(text.find_first_not_of(" \t", begin), end);
        line.append(text, continued ? begin : first, end - (continued ? begin : first));
        differs |= first > begin && first < end;
        const bool has_backslash = line.find('\\') != std::string::npos;
        if (!line.empty() && line[0] == '#') { // assimp continues a comment after a backslash, and never ends it
            differs |= has_backslash;
            line.clear();
        } else if (!line.empty() && line.back() == '\\') {
            differs = true;
            line.back() = ' ';
            ++continued;
            return true;
        } else if (has_backslash) { // in a name or a path, where assimp joins the next line too
            differs = true;
            std::replace(line.begin(), line.end(), '\\', '/');
        }
        const size_t length = line.size();
        sanitize_line(line);
        differs |= line.size() != length;
        clean += line;
        clean.append(continued + 1, '\n');
        line.clear();
        continued = 0;
        return true;
    });
    clean += line;
    return differs || byte_order_mark ? clean : "";
}

std::string with_numbered_vertices(const std::string& text)
{
    std::string numbered;
    size_t number = 0;
    each_line(text, [&](size_t begin, size_t end) {
        if (has_keyword(&text[begin], "v")) {
            numbered += format("v {} {} 0\n", number & 0xffff, number >> 16);
            ++number;
        } else {
            numbered.append(text, begin, end - begin) += '\n';
        }
        return true;
    });
    return numbered;
}

// Assimp reads NaN and infinity as 0 here.
std::string uv_error(const std::string& text, size_t begin, size_t end, size_t line)
{
    const auto is_n = [](char c) { return c == 'n' || c == 'N'; };
    if (!has_keyword(&text[begin], "vt") || std::none_of(&text[begin], &text[end], is_n))
        return "";
    std::vector<double> numbers;
    parse_numbers(&text[begin] + 2, 3, numbers);
    if (std::all_of(numbers.begin(), numbers.end(), [](double x) { return std::isfinite(x); }))
        return "";
    return reason_line(format("line {} has non-finite texture coordinates: \"{}\"", line,
                              OIIO::Strutil::strip(text.substr(begin, end - begin))));
}

// Mark the vertices of a face line. Indices count from 1, or backwards from the `count` vertices so far.
void mark_used(const char* at, size_t count, size_t max_count, std::vector<bool>& used)
{
    for (char* rest = nullptr;; at = rest) {
        const long long number = std::strtoll(at, &rest, 10);
        if (rest == at)
            return;
        const long long vertex = number > 0 ? number - 1 : (long long)count + number;
        if (vertex >= 0 && vertex < (long long)max_count) {
            used.resize(std::max(used.size(), size_t(vertex) + 1));
            used[size_t(vertex)] = true;
        }
        while (*rest != '\0' && !std::strchr(" \t\r\n", *rest))
            ++rest;
        while (*rest == ' ' || *rest == '\t')
            ++rest;
        if (*rest == '\r' || *rest == '\n')
            return;
    }
}

} // namespace

bool is_obj(const FileHead& head)
{
    const char* const keywords[] = { "mtllib", "usemtl", "o", "g", "s", "v", "vt", "vn", "f" };
    bool result = false;
    const std::string text = first_text(head);
    if (text.find('\0') != std::string::npos)
        return false;
    each_line(text, [&](size_t begin, size_t end) {
        const size_t first = std::min(text.find_first_not_of(" \t", begin), end);
        result = std::any_of(std::begin(keywords), std::end(keywords),
                             [&](const char* keyword) { return has_keyword(&text[first], keyword); });
        return first == end || text[first] == '#';
    });
    return result;
}

Inspection inspect_obj(const std::string& original)
{
    Inspection result;
    result.replacement = sanitized(original);
    const std::string& text = result.replacement.empty() ? original : result.replacement;
    std::vector<double> numbers;
    std::vector<bool> used;
    size_t line = 0;
    bool readable = true;
    each_line(text, [&](size_t begin, size_t end) {
        result.error = uv_error(text, begin, end, ++line);
        if (readable && has_keyword(&text[begin], "v")) {
            V3d vertex;
            readable = parse_vertex(&text[begin] + 2, numbers, vertex);
            result.exact_positions.push_back(vertex);
        } else if (has_keyword(&text[begin], "f")) {
            mark_used(&text[begin] + 2, result.exact_positions.size(), text.size(), used);
        }
        return result.error.empty();
    });
    used.resize(result.exact_positions.size());
    std::vector<V3d> corners;
    for (size_t i = 0; i < used.size(); ++i)
        if (used[i])
            corners.push_back(result.exact_positions[i]);
    result.has_numbered_vertices = readable && result.error.empty() && is_far_from_origin(corners);
    if (result.has_numbered_vertices)
        result.replacement = with_numbered_vertices(text);
    else
        result.exact_positions.clear();
    return result;
}

} // namespace vmlight
