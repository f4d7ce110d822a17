// SPDX-License-Identifier: Apache-2.0
#include <vmlight/base/text.h>

#include <algorithm>
#include <cstdlib>
#include <numeric>

#include <locale.h>

namespace vmlight {
namespace {

using OIIO::string_view;

constexpr const char* kWhiteSpace = " \t\n\r\f\v";

} // namespace

bool starts_with(string_view text, string_view start)
{
    return text.substr(0, start.size()) == start;
}

bool ends_with(string_view text, string_view end)
{
    return text.size() >= end.size() && text.substr(text.size() - end.size()) == end;
}

string_view stripped(string_view text)
{
    const size_t first = text.find_first_of(kWhiteSpace) == 0 ? text.find_first_not_of(kWhiteSpace) : 0;
    if (first == string_view::npos)
        return {};
    return text.substr(first, text.find_last_not_of(kWhiteSpace) + 1 - first);
}

std::vector<std::string> split(string_view text, char separator)
{
    std::vector<std::string> parts(1);
    for (const char c : text)
        if (c == separator)
            parts.emplace_back();
        else
            parts.back() += c;
    return parts;
}

std::vector<std::string> split_words(string_view text)
{
    std::vector<std::string> words;
    bool is_in_word = false;
    for (const char c : text) {
        const bool is_space = string_view(kWhiteSpace).find(c) != string_view::npos;
        if (!is_space && !is_in_word)
            words.emplace_back();
        if (!is_space)
            words.back() += c;
        is_in_word = !is_space;
    }
    return words;
}

std::string replaced(string_view text, string_view from, string_view to)
{
    std::string result(text);
    for (size_t at = 0; (at = result.find(from.data(), at, from.size())) != std::string::npos; at += to.size())
        result.replace(at, from.size(), to.data(), to.size());
    return result;
}

std::string in_capitals(std::string text)
{
    for (char& c : text)
        c = c >= 'a' && c <= 'z' ? char(c - 'a' + 'A') : c;
    return text;
}

std::string in_small_letters(std::string text)
{
    for (char& c : text)
        c = c >= 'A' && c <= 'Z' ? char(c - 'A' + 'a') : c;
    return text;
}

size_t edit_distance(string_view a, string_view b)
{
    // Of the start of `a` so far and each start of `b`.
    std::vector<size_t> edits(b.size() + 1);
    std::iota(edits.begin(), edits.end(), size_t(0));
    for (size_t i = 0; i < a.size(); ++i) {
        size_t diagonal = edits[0];
        edits[0] = i + 1;
        for (size_t j = 0; j < b.size(); ++j) {
            const size_t changed = diagonal + (a[i] != b[j]);
            diagonal = edits[j + 1];
            edits[j + 1] = std::min({ changed, edits[j] + 1, diagonal + 1 });
        }
    }
    return edits.back();
}

double number_at(const char* text, char** end)
{
    static const locale_t plain = ::newlocale(LC_ALL_MASK, "C", nullptr);
    return ::strtod_l(text, end, plain);
}

} // namespace vmlight
