// SPDX-License-Identifier: Apache-2.0
// The text of scene lists.
#include <vmlight/base/format.h>
#include <vmlight/base/text_format.h>
#include <vmlight/base/toml_text.h>
#include <vmlight/mesh/import/scene_list.h>

#include <OpenImageIO/filesystem.h>
#include <OpenImageIO/strutil.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <string_view>

namespace vmlight {
namespace {

using Imath::M44d;
using Imath::V3d;

constexpr const char* kKeys[] = { "mesh", "name", "bake", "material", "translate", "rotate", "scale", "matrix" };

bool read_numbers(std::vector<double>& dst, const toml::node& node)
{
    dst.clear();
    if (const toml::array* array = node.as_array()) {
        for (const toml::node& element : *array) {
            const auto number = element.value<double>();
            if (!number || !element.is_number())
                return false;
            dst.push_back(*number);
        }
        return true;
    }
    if (const auto number = node.value<double>(); number && node.is_number())
        dst.push_back(*number);
    return !dst.empty();
}

// Why an entry cannot be read.
struct EntryFault
{
    std::string key, reason; // whose line is named; of one that the entry lacks, the entry's
};

// `fault` is the reason, if false.
bool read_vector(V3d& dst, const toml::table& table, const char* key, bool takes_one, EntryFault& fault)
{
    const toml::node* node = table.get(key);
    std::vector<double> numbers;
    if (!node)
        return true;
    if (!read_numbers(numbers, *node) || !(numbers.size() == 3 || (takes_one && numbers.size() == 1))) {
        fault = { key, format("{} is not {}three numbers in brackets", key, takes_one ? "one number, or " : "") };
        return false;
    }
    dst = numbers.size() == 1 ? V3d(numbers[0]) : V3d(numbers[0], numbers[1], numbers[2]);
    return true;
}

// As written, for column vectors; Imath's are for rows.
bool read_matrix(M44d& dst, const toml::node& node, EntryFault& fault)
{
    std::vector<double> numbers;
    if (!read_numbers(numbers, node) || (numbers.size() != 12 && numbers.size() != 16)) {
        fault = { "matrix", "matrix is not 12 or 16 numbers in brackets, row by row" };
        return false;
    }
    for (size_t i = 0; i < 12; ++i)
        dst[int(i % 4)][int(i / 4)] = numbers[i];
    const double last[] = { 0, 0, 0, 1 };
    if (numbers.size() == 12 || std::equal(last, last + 4, numbers.begin() + 12))
        return true;
    fault = { "matrix", "the last row of matrix is not 0, 0, 0, 1" };
    return false;
}

bool read_transform(M44d& dst, const toml::table& table, EntryFault& fault)
{
    V3d translate(0), rotate(0), scale(1);
    if (!read_vector(translate, table, "translate", false, fault) || !read_vector(rotate, table, "rotate", false, fault)
        || !read_vector(scale, table, "scale", true, fault))
        return false;
    const toml::node* const matrix = table.get("matrix");
    if (matrix && (table.contains("translate") || table.contains("rotate") || table.contains("scale"))) {
        fault = { "matrix", "matrix stands for translate, rotate and scale: give one or the others" };
        return false;
    }
    if (matrix) {
        if (!read_matrix(dst, *matrix, fault))
            return false;
    } else {
        dst.setScale(scale);
        const double degree = M_PI / 180;
        dst *= M44d().rotate(V3d(rotate.x * degree, 0, 0)) * M44d().rotate(V3d(0, rotate.y * degree, 0))
            * M44d().rotate(V3d(0, 0, rotate.z * degree)) * M44d().setTranslation(translate);
    }
    double largest = 0;
    for (int row = 0; row < 4; ++row)
        for (int column = 0; column < 3; ++column) {
            if (!std::isfinite(dst[row][column])) {
                fault = { matrix ? "matrix" : "", "the transform is not finite" };
                return false;
            }
            if (row < 3)
                largest = std::max(largest, std::abs(dst[row][column]));
        }
    // Of a matrix whose largest number is 1.
    const double volume = largest > 0 ? (dst * M44d().scale(V3d(1 / largest))).determinant() : 0;
    if (std::abs(volume) > 1e-12)
        return true;
    fault = { matrix ? "matrix" : "scale",
              "the transform is singular: it leaves the mesh without a volume; instances must not be scaled to 0" };
    return false;
}

bool read_names(std::vector<std::string>& dst, const toml::node& node)
{
    if (const auto name = node.value<std::string>(); name && node.is_string())
        dst.push_back(*name);
    else if (const toml::array* names = node.as_array())
        for (const toml::node& element : *names) {
            if (!element.is_string())
                return false;
            dst.push_back(*element.value<std::string>());
        }
    return !dst.empty();
}

bool read_entry(SceneListEntry& dst, const toml::table& table, const std::string& folder, EntryFault& fault)
{
    for (const auto& [key, value] : table)
        if (std::find(std::begin(kKeys), std::end(kKeys), std::string_view(key)) == std::end(kKeys)) {
            const std::string text(std::string_view { key });
            fault = { text, format("unknown key \"{}\" of an instance", shortened_line(text)) };
            return false;
        }
    const toml::node *mesh = table.get("mesh"), *name = table.get("name"), *bake = table.get("bake"),
                     *material = table.get("material");
    if (!mesh || !mesh->is_string() || mesh->value<std::string>()->empty()) {
        fault = { "mesh", "an instance without mesh, the path of a file in quotes" };
        return false;
    }
    if ((name && !name->is_string()) || (bake && !bake->is_boolean())
        || (material && !read_names(dst.material, *material))) {
        fault = name && !name->is_string() ? EntryFault { "name", "name is not a string" }
            : bake && !bake->is_boolean()
            ? EntryFault { "bake", "bake is neither true nor false" }
            : EntryFault { "material", "material is neither a name in quotes nor an array of them" };
        return false;
    }
    const std::string path = *mesh->value<std::string>();
    dst.mesh = OIIO::Filesystem::path_is_absolute(path) || folder.empty() ? path : folder + "/" + path;
    dst.name = name ? *name->value<std::string>() : "";
    dst.bake = bake && *bake->value<bool>();
    return read_transform(dst.to_object, table, fault);
}

bool read_entries(std::vector<SceneListEntry>& dst, const toml::table& file, const std::string& folder,
                  std::string& error)
{
    for (const auto& [key, value] : file)
        if (std::string_view(key) != "instance") {
            error = format("unknown key \"{}\": a scene list has tables [[instance]] alone",
                           shortened_line(std::string(std::string_view(key))));
            return false;
        }
    const toml::array* const entries = file["instance"].as_array();
    if (!entries || entries->empty()) {
        error = "no [[instance]]";
        return false;
    }
    for (const toml::node& node : *entries) {
        SceneListEntry& entry = dst.emplace_back();
        entry.line = int(node.source().begin.line);
        if (!node.is_table()) {
            error = format("line {}: instance is not a table", entry.line);
            return false;
        }
        const toml::table& table = *node.as_table();
        if (EntryFault fault; !read_entry(entry, table, folder, fault)) {
            const toml::node* const value = table.get(fault.key);
            error = format("line {}: {}", value ? int(value->source().begin.line) : entry.line, fault.reason);
            return false;
        }
    }
    return true;
}

} // namespace

bool parse_scene_list(std::vector<SceneListEntry>& dst, const std::string& text, const std::string& path,
                      std::string& error)
{
    toml::table file;
    if (parse_toml(file, text, path, error) && read_entries(dst, file, OIIO::Filesystem::parent_path(path), error))
        return true;
    // The caller names the file.
    if (const std::string head = format("\"{}\" ", path); OIIO::Strutil::starts_with(error, head))
        error.erase(0, head.size());
    return false;
}

} // namespace vmlight
