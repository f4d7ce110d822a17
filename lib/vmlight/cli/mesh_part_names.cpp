// SPDX-License-Identifier: Apache-2.0
#include <vmlight/cli/mesh_part_names.h>

#include <vmlight/base/format.h>
#include <vmlight/base/utf8.h>

#include <OpenImageIO/strutil.h>

#include <map>

namespace vmlight {

const std::vector<MeshPartPattern>& mesh_part_patterns()
{
    static const std::vector<MeshPartPattern> patterns {
        { "<MATERIAL>", "material", "materials", "--material", &PartFiles::material, &MeshSelection::material,
          vismap_materials },
        { "<INSTANCE>", "instance", "instances", "--node", &PartFiles::node, &MeshSelection::node, vismap_instances },
    };
    return patterns;
}

std::string mesh_part_pattern_list()
{
    std::string list;
    for (const MeshPartPattern& pattern : mesh_part_patterns())
        list += (list.empty() ? "" : " and ") + std::string(pattern.text);
    return list;
}

const MeshPartPattern* mesh_part_pattern(const std::string& path)
{
    for (const MeshPartPattern& pattern : mesh_part_patterns())
        if (path.find(pattern.text) != std::string::npos)
            return &pattern;
    return nullptr;
}

std::string mesh_part_file_name(const std::string& part)
{
    const bool keeps_unicode = is_utf8(part);
    std::string name = part;
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

std::string mesh_part_path(const std::string& path, const MeshPartPattern& pattern, const std::string& name)
{
    return OIIO::Strutil::replace(path, pattern.text, mesh_part_file_name(name), true);
}

std::string same_file_fault(const MeshPartPattern& pattern, const std::vector<std::string>& names)
{
    std::map<std::string, std::string> taken;
    for (const std::string& name : names) {
        const auto [other, is_new] = taken.emplace(mesh_part_file_name(name), name);
        if (!is_new)
            return format("the {} \"{}\" and \"{}\" would both be \"{}\" in file names: rename one of them, or "
                          "bake them one by one with {}",
                          pattern.nouns, other->second, name, other->first, pattern.flag);
    }
    return "";
}

} // namespace vmlight
