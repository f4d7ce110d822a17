// SPDX-License-Identifier: Apache-2.0
#include <vmlight/image/color_space.h>

#include <vmlight/image/primaries.h>

#include <OpenImageIO/filesystem.h>
#include <OpenImageIO/strutil.h>

#include <algorithm>
#include <cctype>

namespace vmlight {

using OIIO::ColorConfig;
using OIIO::Strutil::iequals;

namespace {

// Whether `text` contains `word`, ignoring case, with no letter or digit on either side.
bool contains_word(const std::string& text, const std::string& word)
{
    const auto is_boundary
        = [&](size_t i) { return i >= text.size() || !std::isalnum(static_cast<unsigned char>(text[i])); };
    for (size_t at = 0; !word.empty() && at + word.size() <= text.size(); ++at)
        if (iequals(text.substr(at, word.size()), word) && (at == 0 || is_boundary(at - 1))
            && is_boundary(at + word.size()))
            return true;
    return false;
}

constexpr const char* kNoExtension = ".vmlight-none"; // of no rule

// OIIO 2 and 3 differ. From 3.1 on a config reports whether only its default rule matched, and which spaces are data.
// In 2.4 getColorSpaceFromFilepath() ignores the default rule and instead searches the whole path for any space's name,
// so that "drawing.tif" is Raw: accept such a result only if the file's name or extension gives it.
template <class Config>
auto rule_space(const Config& config, const std::string& path, const std::string&, int)
    -> decltype(config.filepathOnlyMatchesDefaultRule(path), std::string())
{
    return config.filepathOnlyMatchesDefaultRule(path) ? std::string()
                                                       : std::string(config.getColorSpaceFromFilepath(path));
}
template <class Config>
std::string rule_space(const Config& config, const std::string& path, const std::string& named, long)
{
    const std::string space(config.getColorSpaceFromFilepath(path));
    const bool by_rule = space != config.parseColorSpaceFromString(path) || space == named
        || space == config.getColorSpaceFromFilepath("_" + OIIO::Filesystem::extension(path));
    return by_rule ? space : "";
}
template <class Config>
auto is_data(const Config& config, const std::string& space, int) -> decltype(config.isData(space))
{
    return config.isData(space);
}
template <class Config> bool is_data(const Config& config, const std::string& space, long)
{
    return space == space_named(config, "data");
}

} // namespace

bool is_any_of(const std::string& name, const std::vector<std::string>& names)
{
    return std::any_of(names.begin(), names.end(), [&](const std::string& n) { return iequals(n, name); });
}

std::vector<std::string> all_space_names(const ColorConfig& config)
{
    std::vector<std::string> names = config.getColorSpaceNames();
    const size_t spaces = names.size();
    for (size_t i = 0; i < spaces; ++i)
        for (auto& alias : config.getAliases(names[i]))
            names.push_back(alias);
    for (auto& role : config.getRoles())
        names.push_back(role);
    return names;
}

std::string space_named(const ColorConfig& config, const std::string& name)
{
    const char* space = name.empty() ? nullptr : config.getColorSpaceNameByRole(name);
    if (!space)
        return "";
    // OIIO adds names that the config does not have ("linear" for the role scene_linear, whatever its primaries), and a
    // config may have them as aliases for other programs' sake.
    static const std::vector<std::string> invented { "rgb", "default", "srgb", "scene_linear" };
    if (is_any_of(name, { "linear" }))
        return is_any_of(name, config.getColorSpaceNames()) || is_any_of(name, config.getRoles()) ? space : "";
    return !is_any_of(name, invented) || is_any_of(name, all_space_names(config)) ? space : "";
}

std::string first_space_named(const ColorConfig& config, const std::vector<const char*>& names)
{
    for (const char* name : names) {
        std::string space = space_named(config, name);
        if (!space.empty())
            return space;
    }
    return "";
}

PathSpace space_of_path(const ColorConfig& config, const std::string& path)
{
    if (path.empty())
        return {};
    const std::string file = OIIO::Filesystem::filename(path), extension = OIIO::Filesystem::extension(file);
    std::string named(config.parseColorSpaceFromString(file));
    if (!contains_word(file, named))
        named.clear();
    const std::string ruled = rule_space(config, path, named, 0);
    // Which rule matched cannot be asked. One that looks at more than the extension gives another space than it gives
    // to any name with this extension, or a space whatever the extension.
    const std::string other = path.substr(0, path.size() - extension.size()) + kNoExtension;
    const bool ruled_by_name = (!ruled.empty() && ruled != rule_space(config, "_" + extension, "", 0))
        || rule_space(config, other, "", 0) != rule_space(config, std::string("_") + kNoExtension, "", 0);
    const bool by_name = ruled_by_name || !named.empty();
    return { space_named(config, ruled_by_name || named.empty() ? ruled : named), by_name };
}

bool is_data_space(const ColorConfig& config, const std::string& space)
{
    return is_data(config, space, 0);
}

std::string interop_id_of(const ColorConfig& config, const std::string& space)
{
    for (const LinearSpace& known : linear_spaces())
        if (first_space_named(config, known.names) == space)
            return known.interop_id;
    return space;
}

} // namespace vmlight
