// SPDX-License-Identifier: Apache-2.0
#include <vmlight/stage/recipe/toml.h>

#include <vmlight/base/format.h>
#include <vmlight/base/text_format.h>

#include <utility>

namespace vmlight {
namespace {

const char* kind_of(const toml::node& node)
{
    switch (node.type()) {
    case toml::node_type::table:
        return "a table";
    case toml::node_type::array:
        return "an array";
    case toml::node_type::string:
        return "a string";
    case toml::node_type::integer:
        return "an integer";
    case toml::node_type::floating_point:
        return "a float";
    case toml::node_type::boolean:
        return "a boolean";
    default:
        return "a date or time";
    }
}

bool misfit(const toml::node& node, const std::string& wanted, std::string& reason)
{
    reason = format("{} where {} is needed", kind_of(node), wanted);
    return false;
}

bool number_text(std::string& text, const toml::node& node, bool integral)
{
    if (const auto* integer = node.as_integer())
        text = format("{}", integer->get());
    else if (const auto* number = node.as_floating_point(); number && !integral)
        text = format("{}", number->get());
    else
        return false;
    return true;
}

bool word_text(std::string& text, const toml::node& node, const Range& allowed, const char* wanted, std::string& reason)
{
    const auto* word = node.as_string();
    if (!allowed.word || !word)
        return misfit(node, allowed.word ? format("{} or \"{}\"", wanted, allowed.word) : wanted, reason);
    if (word->get() != allowed.word) {
        reason = format("\"{}\" is neither {} nor \"{}\"", word->get(), wanted, allowed.word);
        return false;
    }
    text = word->get();
    return true;
}

bool string_text(std::string& text, const toml::node& node, const char* wanted, std::string& reason)
{
    const auto* string = node.as_string();
    if (!string)
        return misfit(node, wanted, reason);
    text = string->get();
    return true;
}

// One line for each string of an array, or for a string alone.
bool lines_text(std::string& text, const toml::node& node, const char* noun, std::string& reason)
{
    const std::string wanted = format("an array of {}s in quotes", noun);
    const toml::array* elements = node.as_array();
    if (!elements)
        return string_text(text, node, wanted.c_str(), reason);
    for (const toml::node& element : *elements) {
        std::string line;
        if (!string_text(line, element, format("a {} in quotes", noun).c_str(), reason))
            return false;
        if (line.empty() || line.find('\n') != std::string::npos) {
            reason = line.empty() ? "one of the names is empty" : "a name in a list cannot contain a line break";
            return false;
        }
        text += (text.empty() ? "" : "\n") + line;
    }
    return true;
}

} // namespace

bool node_text(std::string& text, const toml::node& node, const int&, const Range& allowed, std::string& reason)
{
    return number_text(text, node, true) || word_text(text, node, allowed, "an integer", reason);
}

bool node_text(std::string& text, const toml::node& node, const double&, const Range& allowed, std::string& reason)
{
    return number_text(text, node, false) || word_text(text, node, allowed, "a number", reason);
}

bool node_text(std::string& text, const toml::node& node, const Size&, const SizeRange&, std::string& reason)
{
    const char* wanted = "a width, [width, height] or \"WIDTHxHEIGHT\"";
    if (number_text(text, node, true))
        return true;
    const toml::array* sides = node.as_array();
    if (!sides)
        return string_text(text, node, wanted, reason);
    std::string width, height;
    if (sides->size() != 2 || !number_text(width, *sides->get(0), true) || !number_text(height, *sides->get(1), true))
        return misfit(node, wanted, reason);
    text = width + "x" + height;
    return true;
}

bool node_text(std::string& text, const toml::node& node, const std::string&, const Choices&, std::string& reason)
{
    return string_text(text, node, "a string", reason);
}

bool node_text(std::string& text, const toml::node& node, const std::vector<std::string>&, const ChoiceSet&,
               std::string& reason)
{
    const toml::array* words = node.as_array();
    if (!words)
        return string_text(text, node, "an array of words in quotes", reason);
    for (const toml::node& element : *words) {
        std::string word;
        if (!string_text(word, element, "a word in quotes", reason))
            return false;
        if (word.empty() || word.find(',') != std::string::npos) {
            reason = word.empty() ? "one of its words is empty" : "a word in a list cannot contain a comma";
            return false;
        }
        text += (text.empty() ? "" : ",") + word;
    }
    return true;
}

bool node_text(std::string& text, const toml::node& node, const std::string&, const Text&, std::string& reason)
{
    return string_text(text, node, "a string", reason);
}

bool node_text(std::string& text, const toml::node& node, const std::string&, const Path&, std::string& reason)
{
    return string_text(text, node, "a path in quotes", reason);
}

bool node_text(std::string& text, const toml::node& node, const std::vector<std::string>&, const Paths&,
               std::string& reason)
{
    return lines_text(text, node, "path", reason);
}

bool node_text(std::string& text, const toml::node& node, const std::vector<std::string>&, const Names&,
               std::string& reason)
{
    return lines_text(text, node, "name", reason);
}

bool node_text(std::string& text, const toml::node& node, const std::vector<double>&, const Numbers& allowed,
               std::string& reason)
{
    const toml::array* numbers = node.as_array();
    if (!numbers)
        return string_text(text, node, format("an array of {} numbers", allowed.count).c_str(), reason);
    for (const toml::node& element : *numbers) {
        std::string number;
        if (!number_text(number, element, false))
            return misfit(element, "a number", reason);
        text += (text.empty() ? "" : ",") + number;
    }
    return true;
}

bool node_text(std::string& text, const toml::node& node, const bool&, const Flag&, std::string& reason)
{
    const auto* flag = node.as_boolean();
    if (!flag)
        return misfit(node, "true or false", reason);
    text = flag->get() ? "true" : "false";
    return true;
}

} // namespace vmlight
