// SPDX-License-Identifier: Apache-2.0
#include <vmlight/mesh/import/obj_text.h>

#include <OpenImageIO/strutil.h>

#include <cmath>

namespace vmlight::obj {

bool has_keyword(const char* line, OIIO::string_view keyword)
{
    const char after = std::equal(keyword.begin(), keyword.end(), line) ? line[keyword.size()] : 0;
    return after == ' ' || after == '\t';
}

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

namespace {

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

} // namespace

std::string sanitized(const std::string& text)
{
    std::string clean, line;
    bool differs = false;
    size_t continued = 0; // lines joined with the next so far
    const size_t byte_order_mark = text.compare(0, 3, "\xef\xbb\xbf") == 0 ? 3 : 0;
    for_each_line(text, [&](size_t begin, size_t end) {
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

} // namespace vmlight::obj
