// SPDX-License-Identifier: Apache-2.0
#include <vmlight/cli/material_files.h>

#include <vmlight/base/format.h>
#include <vmlight/base/utf8.h>

#include <OpenImageIO/strutil.h>

#include <map>

namespace vmlight {
namespace {

constexpr const char* kPattern = "<MATERIAL>";

} // namespace

bool has_material_pattern(const std::string& path)
{
    return path.find(kPattern) != std::string::npos;
}

std::string material_file_name(const std::string& material)
{
    const bool keeps_unicode = is_utf8(material);
    std::string name = material;
    for (char& c : name) {
        const bool is_ascii = static_cast<unsigned char>(c) < 0x80;
        const bool is_plain = (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '-'
            || c == '_' || c == '.';
        if (is_ascii ? !is_plain : !keeps_unicode)
            c = '_';
    }
    if (!name.empty() && name[0] == '.')
        name[0] = '_';
    return name;
}

std::string material_path(const std::string& path, const std::string& material)
{
    return OIIO::Strutil::replace(path, kPattern, material_file_name(material), true);
}

std::string same_file_fault(const std::vector<std::string>& materials)
{
    std::map<std::string, std::string> taken;
    for (const std::string& material : materials) {
        const auto [other, is_new] = taken.emplace(material_file_name(material), material);
        if (!is_new)
            return format("the materials \"{}\" and \"{}\" would both be \"{}\" in file names: rename one of them, or "
                          "bake them one by one with --material",
                          other->second, material, other->first);
    }
    return "";
}

} // namespace vmlight
