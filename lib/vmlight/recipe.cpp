// SPDX-License-Identifier: Apache-2.0
#include <vmlight/recipe.h>

#include <OpenImageIO/filesystem.h>
#include <OpenImageIO/strutil.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <utility>

// Inside this file only: nothing of it is linked or exported, and it throws nothing.
#define TOML_HEADER_ONLY 1
#define TOML_EXCEPTIONS 0
#define TOML_ENABLE_FORMATTERS 0
#define TOML_MAX_NESTED_VALUES 8
#include <toml++/toml.h>

namespace vmlight {
namespace {

using OIIO::string_view;
using OIIO::Strutil::fmt::format;

constexpr uint64_t kLargestFile = 1 << 20;
constexpr size_t kMostDots = 100;
constexpr size_t kLongestReason = 500;

// Texts of the file come back in messages, which are one line.
std::string one_line(string_view text)
{
    std::string line;
    for (const char c : text) {
        const auto byte = static_cast<unsigned char>(c);
        line += byte < 0x20 || byte == 0x7f ? format("\\x{:02x}", byte) : std::string(1, c);
    }
    return line;
}

// A reason with the file's own words in it, which may be many.
std::string reason_line(string_view reason)
{
    return one_line(reason.substr(0, kLongestReason)) + (reason.size() > kLongestReason ? "..." : "");
}

std::string at_line(const std::string& path, uint64_t line)
{
    return line ? format("\"{}\" line {}", path, line) : format("\"{}\"", path);
}

// ---- TOML that toml++ can take ------------------------------------------------------------------------------------
// Version 3.3 has undefined behaviour where a character that is not ASCII stands outside quotes, and what it takes for
// quotes depends on what is wrong before them. So it is given ASCII alone: in quotes, \u says the rest. It also makes a
// table of each part of a dotted key, one in the other, which it takes down by recursion: hence the limit on dots. What
// is refused for these is no TOML either, or of no use in a recipe.

// Bytes of the character at the start of `text`, or 0 if they are no UTF-8.
size_t read_character(string_view text, uint32_t& code)
{
    const auto lead = static_cast<unsigned char>(text[0]);
    const size_t count = lead < 0x80 ? 1 : lead < 0xe0 ? 2 : lead < 0xf0 ? 3 : 4;
    constexpr std::array<uint32_t, 5> kLeast { 0, 0, 0x80, 0x800, 0x10000 };
    if (count > text.size() || (count > 1 && lead < 0xc2) || lead > 0xf4)
        return 0;
    code = count == 1 ? lead : lead & (0xffu >> (count + 1));
    for (size_t i = 1; i < count; ++i) {
        const auto byte = static_cast<unsigned char>(text[i]);
        if ((byte & 0xc0) != 0x80)
            return 0;
        code = code << 6 | (byte & 0x3f);
    }
    const bool good = code >= kLeast[count] && code <= 0x10ffff && !(code >= 0xd800 && code < 0xe000);
    return good ? count : 0;
}

// Append `line` to `dst`, and return "" or what is wrong with it.
std::string append_ascii(std::string& dst, string_view line)
{
    enum
    {
        Plain,
        Basic,
        Literal,
        Comment
    } where
        = Plain;
    size_t dots = 0, count = 0;
    for (size_t i = 0; i < line.size(); i += count) {
        uint32_t code = 0;
        const char c = line[i];
        count = read_character(line.substr(i), code);
        if (count == 0)
            return "not TOML: its bytes are not UTF-8";
        if ((code < 0x20 && c != '\t') || code == 0x7f)
            return format("not TOML: a control character ({})", code);
        if (count > 1) {
            if (where == Plain)
                return "not TOML: a character outside quotes that is not ASCII";
            dst += where == Comment ? "?" : format("\\U{:08x}", code);
        } else if (where == Plain && (c == '"' || c == '\'')) {
            if (line.substr(i, 3) == std::string(3, c))
                return "three quotes in a row: a recipe's texts are of one line";
            where = c == '"' ? Basic : Literal;
            dst += '"';
        } else if (where == Plain) {
            where = c == '#' ? Comment : Plain;
            dots += c == '.';
            dst += c;
            if (dots > kMostDots)
                return format("more than {} dots outside quotes", kMostDots);
        } else if (where == Literal) {
            where = c == '\'' ? Plain : Literal;
            dst += c == '\'' ? "\"" : c == '"' || c == '\\' ? std::string { '\\', c } : std::string(1, c);
        } else {
            const bool escapes
                = where == Basic && c == '\\' && i + 1 < line.size() && (line[i + 1] == '"' || line[i + 1] == '\\');
            where = where == Basic && c == '"' ? Plain : where;
            count = escapes ? 2 : 1;
            dst.append(line.data() + i, count);
        }
    }
    return "";
}

bool to_ascii(std::string& dst, string_view text, const std::string& path, std::string& error)
{
    if (OIIO::Strutil::starts_with(text, "\xEF\xBB\xBF")) // an editor's mark of UTF-8
        text.remove_prefix(3);
    for (uint64_t number = 1; !text.empty(); ++number) {
        const size_t end = std::min(text.find('\n'), text.size());
        string_view line = text.substr(0, end);
        if (end < text.size() && !line.empty() && line.back() == '\r')
            line.remove_suffix(1);
        const std::string fault = append_ascii(dst, line);
        if (!fault.empty()) {
            error = at_line(path, number) + ": " + fault;
            return false;
        }
        dst += '\n';
        text.remove_prefix(std::min(end + 1, text.size()));
    }
    return true;
}

// ---- TOML values as the texts that parse_value() takes -----------------------------------------------------------

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
    const char* wanted = "an array of paths in quotes";
    const toml::array* paths = node.as_array();
    if (!paths)
        return string_text(text, node, wanted, reason);
    for (const toml::node& element : *paths) {
        std::string path;
        if (!string_text(path, element, "a path in quotes", reason))
            return false;
        if (path.empty() || path.find('\n') != std::string::npos) {
            reason = path.empty() ? "one of its names is empty" : "a name in a list cannot hold a line break";
            return false;
        }
        text += (text.empty() ? "" : "\n") + path;
    }
    return true;
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

// ---- Paths -------------------------------------------------------------------------------------------------------

std::string in_folder(const std::string& folder, const std::string& path)
{
    return folder.empty() || path.empty() || path[0] == '/' ? path
        : folder.back() == '/'                              ? folder + path
                                                            : folder + "/" + path;
}

void resolve(std::string& path, const Path&, const std::string& folder)
{
    path = in_folder(folder, path);
}

void resolve(std::vector<std::string>& paths, const Paths&, const std::string& folder)
{
    for (std::string& path : paths)
        path = in_folder(folder, path);
}

template <class Value, class Allowed> void resolve(Value&, const Allowed&, const std::string&) { }

// ---- Values as TOML ----------------------------------------------------------------------------------------------

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

std::string toml_text(const std::vector<std::string>& value, const Paths&)
{
    std::string text;
    for (const std::string& path : value)
        text += "    " + quoted(path) + ",\n";
    return text.empty() ? "[]" : "[\n" + text + "]";
}

// Choices, texts, paths and sizes.
template <class Value, class Allowed> std::string toml_text(const Value& value, const Allowed& allowed)
{
    return quoted(value_text(value, allowed));
}

// ---- Recipes -----------------------------------------------------------------------------------------------------

template <class Recipe>
bool set_from_node(Recipe& recipe, const std::string& key, const toml::node& node, const std::string& folder,
                   std::string& error)
{
    bool found = false, good = false;
    recipe.visit([&](const char* name, auto& value, const auto& allowed, const char*) {
        if (key != name)
            return;
        found = true;
        std::string text, reason;
        good = node_text(text, node, value, allowed, reason) && parse_value(value, text, allowed, reason);
        if (good)
            resolve(value, allowed, folder);
        else
            error = key + ": " + reason;
    });
    // For the name of the nearest.
    return found ? good : set_param(recipe, key, "", error);
}

bool parse_toml(toml::table& dst, string_view text, const std::string& path, std::string& error)
{
    std::string ascii;
    if (!to_ascii(ascii, text, path, error))
        return false;
    toml::parse_result result = toml::parse(ascii);
    if (!result) {
        const toml::parse_error& fault = result.error();
        error
            = at_line(path, fault.source().begin.line) + ": not TOML: " + reason_line(std::string(fault.description()));
        if (error.find("could not determine value type") != std::string::npos)
            error += "; texts need quotes";
        return false;
    }
    dst = std::move(result).table();
    return true;
}

bool read_bytes(std::string& dst, const std::string& path, std::string& error)
{
    const auto failed = [&](const std::string& reason) {
        error = format("\"{}\": {}", path, reason);
        return false;
    };
    if (!OIIO::Filesystem::exists(path))
        return failed("no such file");
    if (!OIIO::Filesystem::is_regular(path))
        return failed("not a file");
    const uint64_t size = OIIO::Filesystem::file_size(path);
    if (size > kLargestFile)
        return failed(format("{} bytes are too many for a recipe; {} are allowed", size, kLargestFile));
    if (size == 0)
        return failed("an empty file");
    dst.resize(size);
    if (OIIO::Filesystem::read_bytes(path, dst.data(), dst.size()) != dst.size())
        return failed("cannot be read");
    return true;
}

using Overrides = std::vector<std::pair<std::string, std::string>>;

bool split_name(std::string& path, Overrides& overrides, const std::string& name, std::string& error)
{
    const size_t mark = name.find('?');
    path = name.substr(0, mark);
    if (mark == std::string::npos || mark + 1 == name.size())
        return true;
    for (const std::string& word : OIIO::Strutil::splits(name.substr(mark + 1), "&")) {
        const size_t equals = word.find('=');
        if (equals == std::string::npos) {
            error = one_line(format("\"{}\": \"{}\" is not KEY=VALUE", name, word));
            return false;
        }
        overrides.emplace_back(word.substr(0, equals), word.substr(equals + 1));
    }
    return true;
}

// What takes several names takes one a line.
template <class Recipe> bool takes_lines(Recipe recipe, const std::string& key)
{
    bool lines = false;
    recipe.visit([&](const char* name, auto&, const auto& allowed, const char*) {
        lines = lines || (key == name && std::is_same_v<std::decay_t<decltype(allowed)>, Paths>);
    });
    return lines;
}

// A file under the name of a tile is the recipe of that tile, unless it says another.
template <class Recipe> Recipe named_recipe(const std::string& path)
{
    Recipe recipe;
    if (const int udim = udim_of_name(path)) {
        udim_of(recipe) = udim;
        recipe.udim_given = true;
    }
    return recipe;
}

template <class Recipe> bool apply(Recipe& recipe, const Overrides& overrides, std::string& error)
{
    for (auto at = overrides.begin(); at != overrides.end(); ++at) {
        const auto same = [&](const auto& other) { return other.first == at->first; };
        if (std::any_of(overrides.begin(), at, same)) {
            if (takes_lines(recipe, at->first))
                continue; // with the first
            error = at->first + ": given twice";
            return false;
        }
        std::string text = at->second;
        for (auto next = at + 1; next != overrides.end() && takes_lines(recipe, at->first); ++next)
            if (same(*next))
                text += "\n" + next->second;
        if (!set_param(recipe, at->first, text, error))
            return false;
    }
    return true;
}

} // namespace

template <class Recipe>
bool read_recipe_text(Recipe& dst, string_view text, const std::string& path, std::string& error)
{
    error.clear();
    toml::table table;
    if (!parse_toml(table, text, path, error))
        return false;
    // The table is sorted by key; the fault to tell is the first of the file.
    Recipe recipe = named_recipe<Recipe>(path);
    recipe.udim_given |= table.contains("udim");
    const std::string folder = OIIO::Filesystem::parent_path(path);
    uint64_t first = 0;
    for (auto&& [key, node] : table) {
        const uint64_t line = key.source().begin.line;
        std::string reason;
        if (!set_from_node(recipe, std::string(key.str()), node, folder, reason) && (first == 0 || line < first)) {
            first = line;
            error = at_line(path, line) + ": " + reason_line(reason);
        }
    }
    if (!error.empty())
        return false;
    dst = recipe;
    return true;
}

template <class Recipe> bool read_recipe(Recipe& dst, const std::string& name, std::string& error)
{
    error.clear();
    std::string path, bytes, reason;
    Overrides overrides;
    if (!split_name(path, overrides, name, error))
        return false;
    Recipe recipe = named_recipe<Recipe>(path);
    const bool alone = !overrides.empty() && !OIIO::Filesystem::exists(path);
    if (!alone && (!read_bytes(bytes, path, error) || !read_recipe_text(recipe, bytes, path, error)))
        return false;
    if (!apply(recipe, overrides, reason)) {
        error = one_line(format("\"{}\": ", name)) + reason_line(reason);
        return false;
    }
    for (const auto& override : overrides)
        recipe.udim_given |= override.first == "udim";
    dst = recipe;
    return true;
}

template <class Recipe> std::string recipe_text(const Recipe& recipe)
{
    Recipe copy = recipe;
    Recipe defaults;
    std::vector<std::string> usual;
    defaults.visit([&](const char*, auto& value, const auto& allowed, const char*) {
        usual.push_back(value_text(value, allowed));
    });
    std::string text;
    size_t index = 0;
    copy.visit([&](const char* name, auto& value, const auto& allowed, const char*) {
        const bool given = copy.udim_given && std::string("udim") == name;
        if (value_text(value, allowed) != usual[index++] || given)
            text += format("{} = {}\n", name, toml_text(value, allowed));
    });
    return text;
}

template bool read_recipe(VismapRecipe&, const std::string&, std::string&);
template bool read_recipe(CfemRecipe&, const std::string&, std::string&);
template bool read_recipe(LightmapRecipe&, const std::string&, std::string&);
template bool read_recipe_text(VismapRecipe&, string_view, const std::string&, std::string&);
template bool read_recipe_text(CfemRecipe&, string_view, const std::string&, std::string&);
template bool read_recipe_text(LightmapRecipe&, string_view, const std::string&, std::string&);
template std::string recipe_text(const VismapRecipe&);
template std::string recipe_text(const CfemRecipe&);
template std::string recipe_text(const LightmapRecipe&);

std::string recipe_path(const std::string& name)
{
    return name.substr(0, name.find('?'));
}

std::string recipe_stage(const std::string& name)
{
    // OIIO, too, chooses a reader by the extension without regard to case.
    const std::string extension = OIIO::Strutil::lower(OIIO::Filesystem::extension(recipe_path(name), false));
    for (const char* stage : { VismapRecipe::kStage, CfemRecipe::kStage, LightmapRecipe::kStage })
        if (extension == stage)
            return stage;
    return "";
}

bool is_recipe_name(const std::string& name)
{
    return !recipe_stage(name).empty();
}

std::string recipe_place(const std::string& name, const std::string& key)
{
    std::string path, bytes, ignored;
    Overrides overrides;
    toml::table table;
    const bool split = split_name(path, overrides, name, ignored);
    const auto same = [&](const auto& override) { return override.first == key; };
    uint64_t line = 0;
    if (split && std::none_of(overrides.begin(), overrides.end(), same) && read_bytes(bytes, path, ignored)
        && parse_toml(table, bytes, path, ignored)) {
        const auto found = table.find(key);
        line = found != table.end() ? found->first.source().begin.line : 0;
    }
    return one_line(at_line(line ? path : name, line) + ": " + key);
}

} // namespace vmlight
