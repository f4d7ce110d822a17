// SPDX-License-Identifier: Apache-2.0
#include <vmlight/stage/recipe/paths.h>

#include <vmlight/stage/recipe/recipe.h>

#include <OpenImageIO/filesystem.h>
#include <OpenImageIO/strutil.h>

#include <algorithm>
#include <filesystem>
#include <map>

namespace vmlight {
namespace {

namespace fs = std::filesystem;

bool is_anchored(const std::string& path)
{
    return path.empty() || path[0] == '/' || path.find("://") != std::string::npos;
}

// Whether `key` names paths in the recipes of `stage`.
bool names_paths(const std::string& stage, const std::string& key)
{
    bool found = false;
    const auto look = [&](const char* name, auto&, const auto& allowed, const char*) {
        using Allowed = std::decay_t<decltype(allowed)>;
        found = found || (key == name && (std::is_same_v<Allowed, Path> || std::is_same_v<Allowed, Paths>));
    };
#define VMLIGHT_LOOK(Recipe)                                                                                           \
    if (stage == Recipe::kStage)                                                                                       \
        Recipe().visit(look);
    VMLIGHT_RECIPES(VMLIGHT_LOOK)
#undef VMLIGHT_LOOK
    return found;
}

std::string in_full(const std::string& path);

// The query from its '?' on, with its paths in full. A path with '&' cannot be in a query.
std::string query_in_full(const std::string& stage, const std::string& query)
{
    if (query.size() < 2)
        return query;
    std::vector<std::string> words = OIIO::Strutil::splits(query.substr(1), "&");
    for (std::string& word : words) {
        const size_t value = std::min(word.find('='), word.size() - 1) + 1;
        const std::string full = in_full(word.substr(value));
        if (names_paths(stage, word.substr(0, value - 1)) && full.find('&') == std::string::npos)
            word.replace(value, std::string::npos, full);
    }
    return "?" + OIIO::Strutil::join(words, "&");
}

std::string in_full(const std::string& path)
{
    const size_t mark = std::min(query_mark(path), path.size());
    const std::string file = path.substr(0, mark), query = query_in_full(recipe_stage(path), path.substr(mark));
    return (is_anchored(file) ? file : fs::absolute(file).lexically_normal().string()) + query;
}

// As short as possible through links in both, if that leads to the same folder; else through none.
fs::path way_from(const fs::path& folder, const fs::path& file)
{
    std::error_code ignored;
    const fs::path plain = file.lexically_normal().lexically_relative(folder.lexically_normal());
    if (fs::equivalent((folder / plain).parent_path(), file.parent_path(), ignored))
        return plain;
    const fs::path place = fs::weakly_canonical(file.parent_path(), ignored) / file.filename();
    return place.lexically_relative(fs::weakly_canonical(folder, ignored));
}

} // namespace

std::string stage_of_extension(const std::string& path)
{
    // OIIO too ignores case when it chooses a reader by extension.
    const std::string extension = OIIO::Strutil::lower(OIIO::Filesystem::extension(path, false));
#define VMLIGHT_COMPARE(Recipe)                                                                                        \
    if (extension == Recipe::kStage)                                                                                   \
        return Recipe::kStage;
    VMLIGHT_RECIPES(VMLIGHT_COMPARE)
#undef VMLIGHT_COMPARE
    return "";
}

size_t query_mark(const std::string& name)
{
    constexpr size_t kNone = std::string::npos;
    size_t mark = name.find('?');
    if (mark == kNone || OIIO::Filesystem::is_regular(name))
        return kNone;
    size_t first = kNone;
    for (; mark != kNone; mark = name.find('?', mark + 1)) {
        const std::string path = name.substr(0, mark);
        if (stage_of_extension(path).empty())
            continue;
        if (OIIO::Filesystem::is_regular(path))
            return mark;
        first = std::min(first, mark);
    }
    // The first '?' of all, if it starts the query of another plugin.
    std::string path;
    std::map<std::string, std::string> query;
    const bool is_anothers = first == kNone && OIIO::Strutil::get_rest_arguments(name, path, query) && !query.empty();
    return is_anothers ? path.size() : first;
}

std::string in_folder(const std::string& folder, const std::string& path)
{
    return folder.empty() || is_anchored(path) ? path : folder.back() == '/' ? folder + path : folder + "/" + path;
}

std::string seen_from(const std::string& folder, const std::string& path)
{
    if (folder.empty() || folder == "." || path.empty())
        return path;
    const size_t mark = std::min(query_mark(path), path.size());
    const std::string file = path.substr(0, mark), query = query_in_full(recipe_stage(path), path.substr(mark));
    return (is_anchored(file) ? file : way_from(fs::absolute(folder), fs::absolute(file)).string()) + query;
}

} // namespace vmlight
