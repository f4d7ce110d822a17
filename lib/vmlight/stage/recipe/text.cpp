// SPDX-License-Identifier: Apache-2.0
// Writes recipes as TOML.
#include <vmlight/base/format.h>
#include <vmlight/stage/recipe/paths.h>
#include <vmlight/stage/recipe/recipe.h>

#include <OpenImageIO/filesystem.h>
#include <OpenImageIO/strutil.h>

namespace vmlight {
namespace {

std::string quoted(const std::string& text)
{
    std::string quoted = "\"";
    for (const char c : text) {
        const auto byte = static_cast<unsigned char>(c);
        if (c == '"' || c == '\\')
            quoted += '\\', quoted += c;
        else
            quoted += byte < 0x20 || byte == 0x7f ? format("\\u{:04x}", byte) : std::string(1, c);
    }
    return quoted + "\"";
}

std::string number_toml(const std::string& text, const Range& allowed)
{
    return allowed.word && text == allowed.word ? quoted(text) : text;
}

std::string toml_text(int value, const Range& allowed)
{
    return number_toml(value_text(value, allowed), allowed);
}

std::string toml_text(double value, const Range& allowed)
{
    return number_toml(value_text(value, allowed), allowed);
}

std::string toml_text(bool value, const Flag& allowed)
{
    return value_text(value, allowed);
}

std::string toml_text(const std::vector<double>& value, const Numbers& allowed)
{
    return "[" + OIIO::Strutil::replace(value_text(value, allowed), ",", ", ", true) + "]";
}

std::string toml_text(const std::vector<std::string>& value, const ChoiceSet& allowed)
{
    const std::string words = value_text(value, allowed);
    return words.empty() ? "[]" : "[" + OIIO::Strutil::replace(quoted(words), ",", "\", \"", true) + "]";
}

std::string lines_toml(const std::vector<std::string>& value)
{
    std::string text;
    for (const std::string& line : value)
        text += "    " + quoted(line) + ",\n";
    return text.empty() ? "[]" : "[\n" + text + "]";
}

std::string toml_text(const std::vector<std::string>& value, const Paths&)
{
    return lines_toml(value);
}

std::string toml_text(const std::vector<std::string>& value, const Names&)
{
    return lines_toml(value);
}

// Choices, texts, paths and sizes.
template <class Value, class Allowed> std::string toml_text(const Value& value, const Allowed& allowed)
{
    return quoted(value_text(value, allowed));
}

void relocate(std::string& path, const Path&, const std::string& folder)
{
    path = seen_from(folder, path);
}

void relocate(std::vector<std::string>& paths, const Paths&, const std::string& folder)
{
    for (std::string& path : paths)
        path = seen_from(folder, path);
}

template <class Value, class Allowed> void relocate(Value&, const Allowed&, const std::string&) { }

} // namespace

template <class Recipe> std::string recipe_text(const Recipe& recipe, const std::string& path)
{
    Recipe copy = recipe;
    const bool has_udim = copy.udim_given || udim_from_name(path) != 0;
    const std::string folder = OIIO::Filesystem::parent_path(path);
    Recipe defaults;
    std::vector<std::string> usual;
    defaults.visit([&](const char*, auto& value, const auto& allowed, const char*) {
        usual.push_back(value_text(value, allowed));
    });
    std::string text;
    size_t index = 0;
    copy.visit([&](const char* name, auto& value, const auto& allowed, const char*) {
        const bool given = has_udim && std::string("udim") == name;
        relocate(value, allowed, folder);
        if (value_text(value, allowed) != usual[index++] || given)
            text += format("{} = {}\n", name, toml_text(value, allowed));
    });
    return text;
}

#define VMLIGHT_DEFINE(Recipe) template std::string recipe_text(const Recipe&, const std::string&);
VMLIGHT_RECIPES(VMLIGHT_DEFINE)
#undef VMLIGHT_DEFINE

} // namespace vmlight
