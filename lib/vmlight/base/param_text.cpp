// SPDX-License-Identifier: Apache-2.0
#include <vmlight/base/param_text.h>

#include <vmlight/base/format.h>
#include <vmlight/base/text.h>

#include <OpenImageIO/strutil.h>

#include <algorithm>

namespace vmlight {

std::string number_text(double value)
{
    // The shorter of two precisions that reads back to the same value.
    std::string brief = format("{:.6g}", value);
    return number_at(brief.c_str()) == value ? brief : format("{:.17g}", value);
}

std::string range_text(const Range& range)
{
    std::string text = format("[{}, {}]", number_text(range.min), number_text(range.max));
    return range.word ? text + format(" or \"{}\"", range.word) : text;
}

std::vector<std::string> words_of(const std::vector<Choice>& choices)
{
    std::vector<std::string> words;
    for (const Choice& choice : choices)
        words.emplace_back(choice.word);
    return words;
}

std::vector<std::string> in_order(std::vector<std::string> words, const ChoiceSet& allowed)
{
    const std::vector<std::string> known = words_of(allowed.choices);
    const auto rank = [&](const std::string& word) { return std::find(known.begin(), known.end(), word); };
    std::stable_sort(words.begin(), words.end(),
                     [&](const std::string& a, const std::string& b) { return rank(a) < rank(b); });
    return words;
}

std::string value_text(int value, const Range& allowed)
{
    return allowed.word && value == allowed.word_value ? allowed.word : format("{}", value);
}

std::string value_text(double value, const Range& allowed)
{
    return allowed.word && value == allowed.word_value ? allowed.word : number_text(value);
}

std::string value_text(const Size& value, const SizeRange&)
{
    return format("{}x{}", value.width, value.height);
}

std::string value_text(const std::string& value, const Choices&)
{
    return value;
}

std::string value_text(const std::vector<std::string>& value, const ChoiceSet& allowed)
{
    return OIIO::Strutil::join(in_order(value, allowed), ",");
}

std::string value_text(const std::string& value, const Text&)
{
    return value;
}

std::string value_text(const std::string& value, const Path&)
{
    return value;
}

std::string value_text(const std::vector<std::string>& value, const Paths&)
{
    return OIIO::Strutil::join(value, "\n");
}

std::string value_text(const std::vector<std::string>& value, const Names&)
{
    return OIIO::Strutil::join(value, "\n");
}

std::string value_text(const std::vector<double>& value, const Numbers&)
{
    std::string text;
    for (double number : value)
        text += (text.empty() ? "" : ",") + number_text(number);
    return text;
}

std::string value_text(bool value, const Flag&)
{
    return value ? "true" : "false";
}

std::string allowed_text(const Range& allowed)
{
    std::string text = format("{}..{}", number_text(allowed.min), number_text(allowed.max));
    return allowed.word ? text + format("|{}", allowed.word) : text;
}

std::string allowed_text(const SizeRange& allowed)
{
    return format("1x1..{}x{}", allowed.max, allowed.max);
}

std::string allowed_text(const Choices& allowed)
{
    return OIIO::Strutil::join(words_of(allowed.choices), "|");
}

std::string allowed_text(const ChoiceSet& allowed)
{
    return OIIO::Strutil::join(words_of(allowed.choices), ",");
}

std::string allowed_text(const Text& allowed)
{
    return allowed.placeholder;
}

std::string allowed_text(const Path&)
{
    return "FILE";
}

std::string allowed_text(const Paths&)
{
    return "FILE";
}

std::string allowed_text(const Names&)
{
    return "NAME";
}

std::string allowed_text(const Numbers& allowed)
{
    return allowed.count > 4 ? format("{} numbers", allowed.count)
                             : OIIO::Strutil::join(std::vector<std::string>(allowed.count, "N"), ",");
}

std::string allowed_text(const Flag&)
{
    return "";
}

} // namespace vmlight
