// SPDX-License-Identifier: Apache-2.0
#include <vmlight/mesh/import/obj.h>

#include <vmlight/base/words.h>

#include <OpenImageIO/strutil.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <cstring>

namespace vmlight {
namespace {

using Imath::V3d;
using OIIO::Strutil::fmt::format;

// Visit where each line begins and ends, until one returns false.
template <class Visit> void each_line(const std::string& text, Visit&& visit)
{
    for (size_t begin = 0; begin < text.size();) {
        const size_t end = std::min(text.find_first_of("\r\n", begin), text.size());
        if (!visit(begin, end))
            return;
        begin = end + (text.compare(end, 2, "\r\n") == 0 ? 2 : 1);
    }
}

// Does it start with the keyword and a blank?
bool is_line_of(const char* line, OIIO::string_view keyword)
{
    const char after = std::equal(keyword.begin(), keyword.end(), line) ? line[keyword.size()] : 0;
    return after == ' ' || after == '\t';
}

// The numbers of a line that starts at `at`, at most `most`, up to what is none. False if something else follows.
bool numbers_of_line(const char* at, size_t most, std::vector<double>& numbers)
{
    numbers.clear();
    while (numbers.size() < most) {
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

// A vertex of 3 numbers, 4 (homogeneous), or 6 (with a colour), as the importer reads them.
bool vertex_of_line(const char* at, std::vector<double>& numbers, V3d& vertex)
{
    if (!numbers_of_line(at, 7, numbers) || (numbers.size() != 3 && numbers.size() != 4 && numbers.size() != 6))
        return false;
    vertex = V3d(numbers[0], numbers[1], numbers[2]);
    if (numbers.size() == 4)
        vertex /= numbers[3];
    return true;
}

// The line's first words.
std::string first_words(const std::string& line, size_t count)
{
    std::vector<std::string> words = OIIO::Strutil::splits(line);
    words.resize(std::min(words.size(), count));
    return OIIO::Strutil::join(words, " ");
}

// What the importer stumbles over, mended: comments behind numbers, an opacity behind a vertex's colour, depths of
// textures that are no numbers.
void mend_line(std::string& line)
{
    const bool is_vertex = is_line_of(line.c_str(), "v"), is_uv = is_line_of(line.c_str(), "vt");
    if (!is_vertex && !is_uv)
        return;
    line.resize(std::min(line.find('#'), line.size()));
    std::vector<double> numbers;
    numbers_of_line(line.c_str() + (is_uv ? 2 : 1), 8, numbers);
    if (is_vertex && numbers.size() == 7)
        line = first_words(line, 4);
    if (is_uv && numbers.size() == 3 && !std::isfinite(numbers[2]))
        line = first_words(line, 3);
}

// The text with one thing a line, or "" if that is how it is. Numbers of lines stay.
std::string tidied(const std::string& text)
{
    std::string tidy, line;
    bool differs = false;
    size_t owed = 0; // line ends within a line that goes on
    const size_t byte_order_mark = text.compare(0, 3, "\xef\xbb\xbf") == 0 ? 3 : 0;
    each_line(text, [&](size_t begin, size_t end) {
        begin += begin == 0 ? byte_order_mark : 0;
        const size_t first = std::min(text.find_first_not_of(" \t", begin), end);
        line.append(text, owed ? begin : first, end - (owed ? begin : first));
        differs |= first > begin && first < end;
        const bool has_backslash = line.find('\\') != std::string::npos;
        if (!line.empty() && line[0] == '#') { // to the importer a comment with a backslash goes on, and ends in none
            differs |= has_backslash;
            line.clear();
        } else if (!line.empty() && line.back() == '\\') {
            differs = true;
            line.back() = ' ';
            ++owed;
            return true;
        } else if (has_backslash) { // in a name or a path, where the importer joins the next line too
            differs = true;
            std::replace(line.begin(), line.end(), '\\', '/');
        }
        const size_t length = line.size();
        mend_line(line);
        differs |= line.size() != length;
        tidy += line;
        tidy.append(owed + 1, '\n');
        line.clear();
        owed = 0;
        return true;
    });
    tidy += line;
    return differs || byte_order_mark ? tidy : "";
}

std::string with_numbered_vertices(const std::string& text)
{
    std::string numbered;
    size_t number = 0;
    each_line(text, [&](size_t begin, size_t end) {
        if (is_line_of(&text[begin], "v")) {
            numbered += format("v {} {} 0\n", number & 0xffff, number >> 16);
            ++number;
        } else {
            numbered.append(text, begin, end - begin) += '\n';
        }
        return true;
    });
    return numbered;
}

// The importer takes NaN and infinity for 0 here.
std::string texture_coordinate_fault(const std::string& text, size_t begin, size_t end, size_t line)
{
    const auto is_n = [](char c) { return c == 'n' || c == 'N'; };
    if (!is_line_of(&text[begin], "vt") || std::none_of(&text[begin], &text[end], is_n))
        return "";
    std::vector<double> numbers;
    numbers_of_line(&text[begin] + 2, 3, numbers);
    if (std::all_of(numbers.begin(), numbers.end(), [](double x) { return std::isfinite(x); }))
        return "";
    return reason_line(format("line {} has texture coordinates that are not finite: \"{}\"", line,
                              OIIO::Strutil::strip(text.substr(begin, end - begin))));
}

// Mark the vertices that a line of a face names, where `count` are known by now. Numbers from 1, or from behind.
void mark_used(const char* at, size_t count, size_t most, std::vector<bool>& used)
{
    for (char* rest = nullptr;; at = rest) {
        const long long number = std::strtoll(at, &rest, 10);
        if (rest == at)
            return;
        const long long vertex = number > 0 ? number - 1 : (long long)count + number;
        if (vertex >= 0 && vertex < (long long)most) {
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

MeshFile inspect_obj(const std::string& original)
{
    MeshFile file;
    file.stand_in = tidied(original);
    const std::string& text = file.stand_in.empty() ? original : file.stand_in;
    std::vector<double> numbers;
    std::vector<bool> used;
    size_t line = 0;
    bool readable = true;
    each_line(text, [&](size_t begin, size_t end) {
        file.fault = texture_coordinate_fault(text, begin, end, ++line);
        if (readable && is_line_of(&text[begin], "v")) {
            V3d vertex;
            readable = vertex_of_line(&text[begin] + 2, numbers, vertex);
            file.positions.push_back(vertex);
        } else if (is_line_of(&text[begin], "f")) {
            mark_used(&text[begin] + 2, file.positions.size(), text.size(), used);
        }
        return file.fault.empty();
    });
    used.resize(file.positions.size());
    std::vector<V3d> corners;
    for (size_t i = 0; i < used.size(); ++i)
        if (used[i])
            corners.push_back(file.positions[i]);
    file.is_numbered = readable && file.fault.empty() && lie_far_from_origin(corners);
    if (file.is_numbered)
        file.stand_in = with_numbered_vertices(text);
    else
        file.positions.clear();
    return file;
}

} // namespace vmlight
