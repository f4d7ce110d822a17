// SPDX-License-Identifier: Apache-2.0
#include <vmlight/base/format.h>
#include <vmlight/base/text_format.h>
#include <vmlight/mesh/import/format_checks.h>
#include <vmlight/mesh/import/obj_text.h>

#include <OpenImageIO/strutil.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <cstring>

namespace vmlight {
namespace {

using namespace obj;
using Imath::V3d;

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

std::string with_numbered_vertices(const std::string& text)
{
    std::string numbered;
    size_t number = 0;
    for_each_line(text, [&](size_t begin, size_t end) {
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
    return shortened_line(format("line {} has non-finite texture coordinates: \"{}\"", line,
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
    for_each_line(text, [&](size_t begin, size_t end) {
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
    for_each_line(text, [&](size_t begin, size_t end) {
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
