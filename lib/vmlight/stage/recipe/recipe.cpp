// SPDX-License-Identifier: Apache-2.0
#include <vmlight/stage/recipe/recipe.h>

#include <vmlight/base/file_stamp.h>
#include <vmlight/base/format.h>
#include <vmlight/base/text_format.h>
#include <vmlight/stage/recipe/paths.h>
#include <vmlight/stage/recipe/toml.h>

#include <OpenImageIO/filesystem.h>
#include <OpenImageIO/strutil.h>

#include <algorithm>
#include <cstdint>
#include <utility>

namespace vmlight {
namespace {

using OIIO::string_view;

constexpr uint64_t kLargestFile = 1 << 20;

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
    // Fails with the nearest known name.
    return found ? good : set_param(recipe, key, "", error);
}

bool read_bytes(std::string& dst, const std::string& path, std::string& error)
{
    log_file(path);
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
        return failed(format("{} bytes are too large for a recipe; the limit is {}", size, kLargestFile));
    if (size == 0)
        return failed("the file is empty");
    dst.resize(size);
    if (OIIO::Filesystem::read_bytes(path, dst.data(), dst.size()) != dst.size())
        return failed("cannot be read");
    return true;
}

using Overrides = std::vector<std::pair<std::string, std::string>>;

bool split_name(std::string& path, Overrides& overrides, const std::string& name, std::string& error)
{
    const size_t mark = std::min(query_mark(name), name.size());
    path = name.substr(0, mark);
    if (mark + 1 >= name.size())
        return true;
    for (const std::string& word : OIIO::Strutil::splits(name.substr(mark + 1), "&")) {
        const size_t equals = word.find('=');
        if (equals == std::string::npos) {
            error = printable_line(format("\"{}\": \"{}\" is not KEY=VALUE", name, word));
            return false;
        }
        overrides.emplace_back(word.substr(0, equals), word.substr(equals + 1));
    }
    return true;
}

// A key with several paths or names takes one per line.
template <class Recipe> bool takes_lines(Recipe recipe, const std::string& key)
{
    bool lines = false;
    recipe.visit([&](const char* name, auto&, const auto& allowed, const char*) {
        lines = lines || (key == name && kTakesLines<std::decay_t<decltype(allowed)>>);
    });
    return lines;
}

// A file named after a tile is the recipe of that tile, unless it sets another.
template <class Recipe> Recipe named_recipe(const std::string& path)
{
    Recipe recipe;
    if (const int udim = udim_from_name(path)) {
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
                continue; // joined with the first
            error = at->first + ": set twice";
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
    // The table is sorted by key, but the error to report is the first in the file.
    Recipe recipe = named_recipe<Recipe>(path);
    recipe.udim_given |= table.contains("udim");
    const std::string folder = OIIO::Filesystem::parent_path(path);
    uint64_t first = 0;
    for (auto&& [key, node] : table) {
        const uint64_t line = key.source().begin.line;
        std::string reason;
        if (!set_from_node(recipe, std::string(key.str()), node, folder, reason) && (first == 0 || line < first)) {
            first = line;
            error = at_line(path, line) + ": " + shortened_line(reason);
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
    Recipe recipe;
    if (!read_bytes(bytes, path, error) || !read_recipe_text(recipe, bytes, path, error))
        return false;
    if (!apply(recipe, overrides, reason)) {
        error = printable_line(format("\"{}\": ", name)) + shortened_line(reason);
        return false;
    }
    for (const auto& override : overrides)
        recipe.udim_given |= override.first == "udim";
    dst = recipe;
    return true;
}

#define VMLIGHT_DEFINE(Recipe)                                                                                         \
    template bool read_recipe(Recipe&, const std::string&, std::string&);                                              \
    template bool read_recipe_text(Recipe&, string_view, const std::string&, std::string&);
VMLIGHT_RECIPES(VMLIGHT_DEFINE)
#undef VMLIGHT_DEFINE

std::string recipe_path(const std::string& name)
{
    return name.substr(0, query_mark(name));
}

std::string recipe_stage(const std::string& name)
{
    return stage_of_extension(recipe_path(name));
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
    return printable_line(at_line(line ? path : name, line) + ": " + key);
}

} // namespace vmlight
