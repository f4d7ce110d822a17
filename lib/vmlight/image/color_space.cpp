// SPDX-License-Identifier: Apache-2.0
#include <vmlight/image/color_space.h>

#include <OpenImageIO/filesystem.h>
#include <OpenImageIO/strutil.h>

#include <algorithm>
#include <cctype>

namespace vmlight {

using OIIO::ColorConfig;
using OIIO::Strutil::iequals;

namespace {

// Scene-linear interop ids, the names of these spaces in old and new configs, and the xy of red, green, blue and white.
struct KnownSpace
{
    const char* interop_id;
    std::vector<const char*> names;
    float chromaticities[8];
};

const std::vector<KnownSpace>& known_spaces()
{
    static const std::vector<KnownSpace> spaces {
        { "lin_ap1_scene",
          { "lin_ap1_scene", "lin_ap1", "ACEScg", "ACES - ACEScg" },
          { 0.713f, 0.293f, 0.165f, 0.83f, 0.128f, 0.044f, 0.32168f, 0.33767f } },
        { "lin_ap0_scene",
          { "lin_ap0_scene", "lin_ap0", "ACES2065-1", "ACES - ACES2065-1" },
          { 0.7347f, 0.2653f, 0.0f, 1.0f, 0.0001f, -0.077f, 0.32168f, 0.33767f } },
        { kLinearRec709,
          { kLinearRec709, "lin_rec709", "lin_srgb", "Linear Rec.709 (sRGB)", "Utility - Linear - sRGB" },
          { 0.64f, 0.33f, 0.3f, 0.6f, 0.15f, 0.06f, 0.3127f, 0.329f } },
    };
    return spaces;
}

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
    // OIIO adds names that the config does not have ("linear" for the role scene_linear, whatever its primaries).
    static const std::vector<std::string> invented { "linear", "rgb", "default", "srgb", "scene_linear" };
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

std::string space_of_path(const ColorConfig& config, const std::string& path)
{
    if (path.empty())
        return "";
    const std::string file = OIIO::Filesystem::filename(path);
    std::string named(config.parseColorSpaceFromString(file));
    if (!contains_word(file, named))
        named.clear();
    const std::string ruled = rule_space(config, path, named, 0);
    return space_named(config, ruled.empty() ? named : ruled);
}

bool is_data_space(const ColorConfig& config, const std::string& space)
{
    return is_data(config, space, 0);
}

std::string interop_id_of(const ColorConfig& config, const std::string& space)
{
    for (auto& known : known_spaces())
        if (first_space_named(config, known.names) == space)
            return known.interop_id;
    return space;
}

const float* chromaticities_of(const std::string& interop_id)
{
    for (auto& known : known_spaces())
        if (known.interop_id == interop_id)
            return known.chromaticities;
    return nullptr;
}

} // namespace vmlight
