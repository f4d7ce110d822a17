// SPDX-License-Identifier: Apache-2.0
#include <vmlight/base/params.h>

#include <vmlight/base/format.h>
#include <vmlight/base/param_text.h>
#include <vmlight/base/text.h>
#include <vmlight/base/text_format.h>

#include <OpenImageIO/strutil.h>

#include <algorithm>
#include <cmath>

namespace vmlight {
namespace {

using OIIO::string_view;

// OIIO's stof/stoi parse a leading number and ignore the rest; here the whole text must be one finite number.
bool whole_number_text(string_view text, double& value)
{
    const std::string trimmed(stripped(text));
    char* end = nullptr;
    if (trimmed.empty() || trimmed.find_first_of("xX") != std::string::npos) // no hexadecimal
        return false;
    value = number_at(trimmed.c_str(), &end) + 0.0; // -0 becomes 0
    return end == trimmed.c_str() + trimmed.size() && std::isfinite(value);
}

bool parse_number(double& dst, string_view text, const Range& allowed, bool integral, std::string& error)
{
    double value = 0;
    if (allowed.word && stripped(text) == allowed.word) {
        dst = allowed.word_value;
        return true;
    }
    if (!whole_number_text(text, value) || (integral && value != std::floor(value))) {
        error = format("\"{}\" is not a {}", text, integral ? "whole number" : "number");
        if (allowed.word)
            error += format(" or \"{}\"", allowed.word);
        return false;
    }
    if (!(value >= allowed.min && value <= allowed.max)) {
        error = format("{} is not in {}", stripped(text), range_text(allowed));
        if (allowed.word && value == 0) // what other programs take for "none"
            error += format("; did you mean \"{}\"?", allowed.word);
        return false;
    }
    dst = value;
    return true;
}

} // namespace

bool parse_value(int& dst, string_view text, const Range& allowed, std::string& error)
{
    double value = 0;
    if (!parse_number(value, text, allowed, true, error))
        return false;
    dst = int(value);
    return true;
}

bool parse_value(double& dst, string_view text, const Range& allowed, std::string& error)
{
    return parse_number(dst, text, allowed, false, error);
}

bool parse_value(Size& dst, string_view text, const SizeRange& allowed, std::string& error)
{
    const std::string trimmed(stripped(text));
    const size_t cross = trimmed.find('x');
    const Range range { 1, double(allowed.max) };
    int width = 0, height = 0;
    std::string reason;
    bool good = parse_value(width, trimmed.substr(0, cross), range, reason);
    if (good && cross != std::string::npos)
        good = parse_value(height, trimmed.substr(cross + 1), range, reason);
    else
        height = std::max(1, int(width * allowed.height_share));
    if (!good) {
        error = format("\"{}\" is not WIDTH or WIDTHxHEIGHT in pixels, each from 1 to {}", text, allowed.max);
        return false;
    }
    dst = { width, height };
    return true;
}

bool parse_value(std::string& dst, string_view text, const Choices& allowed, std::string& error)
{
    for (const Choice& choice : allowed.choices)
        if (text == choice.word) {
            dst = choice.word;
            return true;
        }
    error = format("\"{}\" is not one of {}", text, OIIO::Strutil::join(words_of(allowed.choices), ", "));
    return false;
}

bool parse_value(std::vector<std::string>& dst, string_view text, const ChoiceSet& allowed, std::string& error)
{
    const std::vector<std::string> known = words_of(allowed.choices);
    std::vector<std::string> words;
    if (!stripped(text).empty())
        words = split(text, ',');
    for (auto word = words.begin(); word != words.end(); ++word) {
        *word = std::string(stripped(*word));
        if (std::find(known.begin(), known.end(), *word) == known.end()) {
            const std::string near = nearest_name(*word, known);
            error = format("\"{}\" is not one of {}{}", *word, OIIO::Strutil::join(known, ", "),
                           near.empty() ? "" : format("; did you mean \"{}\"?", near));
            return false;
        }
        if (std::find(words.begin(), word, *word) != word) {
            error = format("\"{}\" is given twice", *word);
            return false;
        }
    }
    dst = in_order(words, allowed);
    return true;
}

bool parse_value(std::string& dst, string_view text, const Text&, std::string&)
{
    dst = std::string(text);
    return true;
}

bool parse_value(std::string& dst, string_view text, const Path&, std::string& error)
{
    if (text.find('\0') != string_view::npos) {
        error = "a name cannot contain a zero byte";
        return false;
    }
    dst = std::string(text);
    return true;
}

bool parse_value(std::vector<std::string>& dst, string_view text, const Paths&, std::string& error)
{
    std::vector<std::string> paths;
    if (!text.empty())
        paths = split(text, '\n');
    for (std::string& path : paths) {
        if (!parse_value(path, path, Path {}, error))
            return false;
        if (path.empty()) {
            error = "one of the names is empty";
            return false;
        }
    }
    dst = paths;
    return true;
}

bool parse_value(std::vector<std::string>& dst, string_view text, const Names&, std::string& error)
{
    return parse_value(dst, text, Paths {}, error);
}

bool parse_value(std::vector<double>& dst, string_view text, const Numbers& allowed, std::string& error)
{
    std::string spaced(text);
    std::replace(spaced.begin(), spaced.end(), ',', ' ');
    std::vector<double> numbers;
    for (const std::string& word : split_words(spaced)) {
        double value = 0;
        if (!whole_number_text(word, value)) {
            error = format("\"{}\" in \"{}\" is not a number", word, text);
            return false;
        }
        numbers.push_back(value);
    }
    if (!numbers.empty() && numbers.size() != allowed.count) {
        error = format("\"{}\" has {} {}, expected {}", text, numbers.size(),
                       plural(int64_t(numbers.size()), "number", "numbers"), allowed.count);
        return false;
    }
    dst = numbers;
    return true;
}

bool parse_value(bool& dst, string_view text, const Flag&, std::string& error)
{
    if (text == "true" || text == "1" || text == "false" || text == "0") {
        dst = text == "true" || text == "1";
        return true;
    }
    error = format("\"{}\" is not true or false", text);
    return false;
}

std::string nearest_name(string_view name, const std::vector<std::string>& names)
{
    std::string best;
    size_t fewest = std::max<size_t>(2, name.size() / 3) + 1;
    for (const std::string& candidate : names) {
        const size_t edits = edit_distance(name, candidate);
        if (edits < fewest) {
            fewest = edits;
            best = candidate;
        }
    }
    return best;
}

std::string metadata_name(const char* parameter)
{
    return format("vmlight:{}", parameter);
}

} // namespace vmlight
